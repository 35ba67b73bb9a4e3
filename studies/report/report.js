"use strict";
// Pictures open over the page, magnified by whole numbers: a pixel stays a square.
(function zoom() {
  const scales = [1, 2, 3, 4, 6, 8, 12, 16];
  const dialog = document.createElement("dialog");
  dialog.className = "zoom";
  dialog.innerHTML =
    '<div class="zoom-bar"><button type="button" data-step="-1" aria-label="smaller">−</button><output></output>' +
    '<button type="button" data-step="1" aria-label="larger">+</button><span class="pixel"></span>' +
    '<button type="button" data-close>Close</button></div><div class="zoom-view"><img alt=""></div>';
  document.body.append(dialog);
  const view = dialog.querySelector(".zoom-view"), shown = view.querySelector("img");
  const pixel = dialog.querySelector(".pixel");
  let place = 1, texels = null, counts = null, unit = "";

  // Keeps what is in the middle of the view there.
  function magnify(step) {
    const before = scales[place];
    place = Math.min(Math.max(place + step, 0), scales.length - 1);
    const ratio = scales[place] / before;
    const x = (view.scrollLeft + view.clientWidth / 2) * ratio, y = (view.scrollTop + view.clientHeight / 2) * ratio;
    shown.style.width = shown.naturalWidth * scales[place] + "px";
    dialog.querySelector("output").textContent = scales[place] + "×";
    view.scrollTo(x - view.clientWidth / 2, y - view.clientHeight / 2);
  }

  function texels_of(image) {
    const canvas = document.createElement("canvas");
    canvas.width = image.naturalWidth;
    canvas.height = image.naturalHeight;
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height);
  }

  function open(image) {
    shown.src = image.src;
    shown.alt = image.alt;
    pixel.textContent = "";
    texels = counts = null;
    unit = image.dataset.unit;
    dialog.showModal();
    const numbers = unit ? new Image() : shown;
    if (unit) numbers.src = image.dataset.counts;
    Promise.all([shown.decode(), numbers.decode()]).then(() => {
      texels = texels_of(shown);
      if (unit) counts = texels_of(numbers);
      magnify(0);
    }).catch(() => {});  // another one has taken its place
  }

  // Of the square of pixels that it is in.
  function count_at(x, y) {
    const square = texels.width / counts.width;
    const [r, g, b] = counts.data.slice(4 * (Math.floor(y / square) * counts.width + Math.floor(x / square)));
    const count = r + 256 * g + 65536 * b;
    return `${count}${count === 0xffffff ? " or more" : ""} ${unit}`;
  }

  shown.addEventListener("pointermove", (event) => {
    if (!texels) return;
    const x = Math.floor(event.offsetX / scales[place]), y = Math.floor(event.offsetY / scales[place]);
    if (x < 0 || y < 0 || x >= texels.width || y >= texels.height) return;
    const [r, g, b] = texels.data.slice(4 * (y * texels.width + x));
    pixel.textContent = `pixel ${x},${y}: ${counts ? count_at(x, y) : `${r} ${g} ${b}`}`;
  });
  dialog.addEventListener("click", (event) => {
    if (event.target.dataset.step) magnify(Number(event.target.dataset.step));
    if ("close" in event.target.dataset) dialog.close();
  });
  dialog.addEventListener("keydown", (event) => {
    if (event.key === "+" || event.key === "=") magnify(1);
    if (event.key === "-") magnify(-1);
  });
  for (const button of document.querySelectorAll(".magnify"))
    button.addEventListener("click", () => open(button.querySelector("img")));
  for (const layers of document.querySelectorAll(".layers"))
    layers.addEventListener("click", (event) => {
      const box = layers.getBoundingClientRect();
      const cut = parseFloat(layers.style.getPropertyValue("--cut") || "50");
      const left = (100 * (event.clientX - box.left)) / box.width < cut;
      open(layers.querySelector(left ? ".over" : ".under:not([hidden])"));
    });
})();

// The slider moves the line between two pictures; the choice beside it says which one lies under the other.
for (const comparison of document.querySelectorAll(".comparison")) {
  const layers = comparison.querySelector(".layers");
  comparison.querySelector("input[type=range]").addEventListener("input", (event) =>
    layers.style.setProperty("--cut", event.target.value + "%"));
  for (const choice of comparison.querySelectorAll("input[type=radio]"))
    choice.addEventListener("change", () => {
      for (const under of layers.querySelectorAll(".under")) under.hidden = under.dataset.name !== choice.value;
    });
}
