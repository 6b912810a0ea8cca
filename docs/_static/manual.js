// Blocks that scroll can be scrolled by keys.
document.addEventListener("DOMContentLoaded", () => {
    document.querySelectorAll("pre").forEach((block) => { block.tabIndex = 0; });
});
