// The page needs none of this: it opens the claim that a link leads to, a tile shows the claims that
// it counts, and all again, and the contents mark where one is.
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
  const claims = [...document.querySelectorAll(".claim[data-told]")];
  const tiles = [...document.querySelectorAll(".tile[data-told]")].filter((tile) =>
    claims.some((claim) => claim.dataset.told === tile.dataset.told));
  const only = { told: null, severity: "", words: "" };
  const show = (told) => {
    only.told = told;
    for (const tile of tiles) tile.querySelector("button").setAttribute("aria-pressed", tile.dataset.told === told);
    for (const claim of claims) {
      const of = claim.closest(".group")?.id + " " + claim.querySelector("summary").textContent + claim.dataset.in;
      claim.hidden = (told !== null && claim.dataset.told !== told) ||
        (only.severity !== "" && claim.dataset.severity !== only.severity) ||
        !only.words.toLowerCase().split(/\s+/).every((word) => of.toLowerCase().includes(word));
    }
    for (const group of document.querySelectorAll(".group"))
      group.hidden = !group.querySelector(".claim:not([hidden])");
  };
  for (const tile of tiles) {
    const button = document.createElement("button");
    button.append(...tile.childNodes);
    tile.append(button);
    button.setAttribute("aria-pressed", "false");
    button.addEventListener("click", () => {
      const told = button.getAttribute("aria-pressed") === "true" ? null : tile.dataset.told;
      show(told);
      if (told !== null) claims[0].closest(".group").parentElement.scrollIntoView();
    });
  }
  const all = () => {
    for (const field of document.querySelectorAll(".filters > *")) field.value = "";
    only.severity = only.words = "";
    show(null);
  };
  addEventListener("hashchange", () => {
    if (document.getElementById(location.hash.slice(1))?.closest("[hidden]")) all();
  }, { capture: true });
  // All statements with their readings in one list, what is refuted in each reading first.
  const groups = [...document.querySelectorAll(".group")];
  const RANKS = ["refuted", "undecided", "measured"];
  const rank = (claims) => (RANKS.indexOf(claims[0].dataset.told) + RANKS.length + 1) % (RANKS.length + 1);
  if (claims.some((claim) => claim.dataset.told === "refuted") && claims.length > 1) {
    const [button, list] = [document.createElement("button"), document.createElement("div")];
    button.className = "sort";
    button.textContent = "Refuted first";
    button.setAttribute("aria-pressed", "false");
    groups[0].before(button, list);
    const kinds = [...new Set(claims.map((claim) => claim.dataset.severity).filter(Boolean))];
    if (kinds.length) {
      const [filters, words, severity] = ["p", "input", "select"].map((name) => document.createElement(name));
      filters.className = "filters";
      Object.assign(words, { type: "search", placeholder: "library, method or words", ariaLabel: "Show claims with these words" });
      severity.ariaLabel = "Show one kind of mistake";
      severity.append(new Option("of every kind", ""), ...kinds.map((kind) => new Option(kind, kind)));
      words.addEventListener("input", () => { only.words = words.value.trim(); show(only.told); });
      severity.addEventListener("change", () => { only.severity = severity.value; show(only.told); });
      filters.append(words, severity);
      button.before(filters);
    }
    list.className = "group";
    button.addEventListener("click", () => {
      const sorted = button.getAttribute("aria-pressed") === "false";
      button.setAttribute("aria-pressed", sorted);
      for (const group of groups) for (const claim of claims.filter((each) => each.home === group)) group.append(claim);
      if (!sorted) return;
      const statements = claims.reduce((found, claim) =>
        claim.classList.contains("again") ? [...found.slice(0, -1), [...found.at(-1), claim]] : [...found, [claim]], []);
      list.append(...statements.toSorted((a, b) => rank(a) - rank(b)).flat());
    });
    for (const claim of claims) claim.home = claim.parentElement;
  }
  // Where they stand at the side they can be scrolled, so a keyboard must reach what is in them.
  document.querySelector(".contents > details").open = matchMedia("(min-width: 1100px)").matches;
  const links = new Map([...document.querySelectorAll(".contents a")].map((link) =>
    [document.getElementById(link.hash.slice(1)), link]));
  const mark = () => {
    const passed = [...links.keys()].filter((each) => each?.offsetParent && each.getBoundingClientRect().top < innerHeight / 3);
    for (const link of links.values()) link.removeAttribute("aria-current");
    links.get(passed.at(-1))?.setAttribute("aria-current", "location");
  };
  addEventListener("scroll", mark, { passive: true });
  reveal();
})();
