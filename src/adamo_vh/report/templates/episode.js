"use strict";
(() => {
  const all = (query, root = document) => [...root.querySelectorAll(query)];
  const turns = all(".turn");
  const links = all(".index [data-tone]");
  const poses = all(".pose");
  const box = document.querySelector(".lightbox");
  const stage = box.querySelector(".stage");
  const caption = box.querySelector(".told");
  const lens = document.querySelector(".lens");
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
    lens.hidden = true;
    stage.replaceChildren(copy);
    stage.className = `stage ${button.dataset.zoom}`;
    const words = button.closest("figure").querySelector("figcaption").cloneNode(true);
    caption.replaceChildren(...words.childNodes);
    if (!box.open) box.showModal();
    stage.focus();
  }

  // Every pixel of the picture, or all of it; the point that was meant stays in sight.
  function toggle(x = 0.5, y = 0.5) {
    if (!stage.classList.contains("view")) return;
    if (!stage.classList.toggle("full")) return;
    stage.scrollLeft = x * stage.scrollWidth - stage.clientWidth / 2;
    stage.scrollTop = y * stage.scrollHeight - stage.clientHeight / 2;
  }

  // A lens for those who can hover: the pixels under the pointer, one to one.
  function magnify(event) {
    const image = event.currentTarget.querySelector("img");
    const place = image.getBoundingClientRect();
    if (event.pointerType !== "mouse" || image.naturalWidth < place.width * 1.3) return;
    if (lens.dataset.of !== image.id) {
      const copy = new Image();
      copy.src = image.src;
      copy.alt = "";
      lens.replaceChildren(copy);
      lens.dataset.of = image.id;
    }
    lens.hidden = false;
    const [width, height] = [lens.clientWidth, lens.clientHeight];
    const x = ((event.clientX - place.left) / place.width) * image.naturalWidth;
    const y = ((event.clientY - place.top) / place.height) * image.naturalHeight;
    lens.firstChild.style.transform = `translate(${width / 2 - x}px, ${height / 2 - y}px)`;
    const left = event.clientX + 28 + width < window.innerWidth ? event.clientX + 28 : event.clientX - 28 - width;
    const top = Math.max(8, Math.min(window.innerHeight - height - 12, event.clientY - height / 2));
    lens.style.transform = `translate(${Math.max(8, left)}px, ${top}px)`;
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
  for (const button of all('.zoom[data-zoom="view"]')) {
    button.addEventListener("pointermove", magnify);
    button.addEventListener("pointerleave", () => { lens.hidden = true; });
  }
  for (const button of all("[data-go]")) {
    button.addEventListener("click", () => step(Number(button.dataset.go)));
  }
  for (const link of all(".index [data-tone], .node, .same")) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      go(turns.findIndex((turn) => `#${turn.id}` === link.getAttribute("href")));
    });
  }
  box.addEventListener("click", (event) => {
    // A click on the picture shows its pixels one to one; anywhere else closes.
    if (event.target.closest(".view img")) {
      const place = event.target.getBoundingClientRect();
      toggle((event.clientX - place.left) / place.width, (event.clientY - place.top) / place.height);
    } else if (!event.target.closest("svg")) box.close();
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "z" && box.open) {
      event.preventDefault();
      toggle();
      return;
    }
    // The arrows move an enlarged picture that is larger than the window.
    if (stage.classList.contains("full") && box.open && event.key.startsWith("Arrow")) return;
    const by = { ArrowRight: 1, j: 1, ArrowLeft: -1, k: -1 }[event.key];
    if (by) {
      event.preventDefault();
      step(by);
    } else if (event.key === "Enter" && document.activeElement === turns[active] && !box.open) {
      const button = viewed(turns[active]);
      if (button) enlarge(button);
    }
  });
  window.addEventListener("scroll", () => { lens.hidden = true; }, { passive: true });
  window.addEventListener("scroll", follow, { passive: true });
  window.addEventListener("resize", follow, { passive: true });

  const named = turns.findIndex((turn) => `#${turn.id}` === window.location.hash);
  if (named >= 0) go(named);
  else follow();
})();
