"use strict";
(() => {
  const all = (query, root = document) => [...root.querySelectorAll(query)];
  const turns = all(".turn");
  const links = all(".index a");
  const poses = all(".pose");
  const box = document.querySelector(".lightbox");
  const stage = box.querySelector(".stage");
  const caption = box.querySelector(".caption");
  const where = document.querySelector(".where");
  let active = -1;
  let pinned = null; // Scroll position after a jump: it decides nothing until the reader scrolls.

  // Each picture is in the page once; small copies borrow it.
  for (const link of all("[data-picture]")) {
    const source = document.getElementById(link.dataset.picture);
    if (!source) continue;
    const copy = new Image();
    copy.src = source.src;
    copy.alt = "";
    link.prepend(copy);
  }

  function activate(index) {
    if (index === active || !turns.length) return;
    active = index;
    const turn = turns[index];
    turns.forEach((item, i) => item.classList.toggle("active", i === index));
    links.forEach((link, i) => {
      if (i === index) link.setAttribute("aria-current", "step");
      else link.removeAttribute("aria-current");
    });
    for (const pose of poses) pose.classList.toggle("on", pose.dataset.turn === turn.id);
    where.textContent = `${turn.getAttribute("aria-label")} · ${index + 1} of ${turns.length}`;
    const list = document.querySelector(".index");
    const link = links[index];
    if (link.offsetTop < list.scrollTop) list.scrollTop = link.offsetTop;
    const below = link.offsetTop + link.offsetHeight - list.clientHeight;
    if (below > list.scrollTop) list.scrollTop = below;
  }

  function go(index) {
    const next = Math.max(0, Math.min(turns.length - 1, index));
    if (!turns[next]) return;
    turns[next].scrollIntoView({ block: "start" });
    turns[next].focus({ preventScroll: true });
    pinned = window.scrollY;
    activate(next);
  }

  function follow() {
    if (pinned !== null && Math.abs(window.scrollY - pinned) < 2) return;
    pinned = null;
    const line = window.innerHeight * 0.35;
    let index = 0;
    turns.forEach((turn, i) => {
      if (turn.getBoundingClientRect().top <= line) index = i;
    });
    activate(index);
  }

  function enlarge(button) {
    const what = button.querySelector("img, svg");
    const copy = what.cloneNode(true);
    copy.removeAttribute("id");
    stage.replaceChildren(copy);
    stage.className = `stage ${button.dataset.zoom}`;
    const words = button.closest("figure").querySelector("figcaption").cloneNode(true);
    caption.replaceChildren(...words.childNodes);
    if (!box.open) box.showModal();
  }

  // The view of a turn, in the turn that shows it.
  function viewed(turn) {
    const link = turn.querySelector(".sight [data-picture]");
    const image = link ? document.getElementById(link.dataset.picture) : turn.querySelector(".sight img");
    return image && image.closest(".zoom");
  }

  function step(by) {
    go(active + by);
    if (!box.open || stage.classList.contains("map")) return;
    const button = viewed(turns[active]);
    if (button) enlarge(button);
  }

  for (const button of all(".zoom")) button.addEventListener("click", () => enlarge(button));
  for (const button of all("[data-go]")) {
    button.addEventListener("click", () => step(Number(button.dataset.go)));
  }
  for (const link of all('.index a, .node, .same')) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      go(turns.findIndex((turn) => `#${turn.id}` === link.getAttribute("href")));
    });
  }
  box.addEventListener("click", (event) => {
    // A click on the picture shows its pixels one to one; anywhere else closes.
    if (event.target.closest(".view img")) stage.classList.toggle("full");
    else if (!event.target.closest("svg")) box.close();
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const by = { ArrowRight: 1, j: 1, ArrowLeft: -1, k: -1 }[event.key];
    if (by) {
      event.preventDefault();
      step(by);
    } else if (event.key === "Enter" && document.activeElement === turns[active] && !box.open) {
      const button = viewed(turns[active]);
      if (button) enlarge(button);
    }
  });
  window.addEventListener("scroll", follow, { passive: true });
  window.addEventListener("resize", follow, { passive: true });

  const named = turns.findIndex((turn) => `#${turn.id}` === window.location.hash);
  if (named >= 0) go(named);
  else follow();
})();
