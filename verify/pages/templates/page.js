// The page needs none of this: it opens the claim that a link leads to, and all for printing.
(() => {
  const reveal = () => {
    const target = document.getElementById(location.hash.slice(1));
    if (!target) return;
    const own = target.querySelector(":scope > details");
    if (own) own.open = true;
    for (let at = target; at; at = at.parentElement) if (at.localName === "details") at.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", reveal);
  document.addEventListener("click", (event) => {
    const link = event.target.closest('a[href^="#"]');
    if (link && link.hash === location.hash) reveal();
  });
  if (!CSS.supports("selector(::details-content)"))
    addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((each) => (each.open = true)));
  reveal();
})();
