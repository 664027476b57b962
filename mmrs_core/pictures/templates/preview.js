"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const map = document.querySelector("svg.map");
  const tip = document.getElementById("tip");
  const slider = document.getElementById("time");
  const now = document.getElementById("now");
  const play = document.getElementById("play");
  const whole = map.viewBox.baseVal;
  const size = { width: whole.width, height: whole.height };
  let view = { x: 0, y: 0, width: size.width, height: size.height };

  const show = () => {
    map.setAttribute("viewBox", `${view.x} ${view.y} ${view.width} ${view.height}`);
    map.style.setProperty("--k", view.width / size.width);
    document.querySelectorAll(".dot").forEach((dot) => dot.setAttribute("r", (8 * view.width) / size.width));
  };

  const placeOf = (event) => {
    const point = new DOMPoint(event.clientX, event.clientY);
    return point.matrixTransform(map.getScreenCTM().inverse());
  };

  map.addEventListener("wheel", (event) => {
    event.preventDefault();
    const at = placeOf(event);
    const wanted = view.width * Math.exp(event.deltaY * 0.0015);
    const width = Math.min(Math.max(wanted, size.width / 60), size.width * 2);
    const factor = width / view.width;
    view = {
      x: at.x - (at.x - view.x) * factor,
      y: at.y - (at.y - view.y) * factor,
      width,
      height: view.height * factor,
    };
    show();
  }, { passive: false });

  let grip = null;
  map.addEventListener("pointerdown", (event) => {
    grip = placeOf(event);
    map.setPointerCapture(event.pointerId);
    map.classList.add("dragged");
  });
  map.addEventListener("pointermove", (event) => {
    if (!grip) return;
    const at = placeOf(event);
    view.x += grip.x - at.x;
    view.y += grip.y - at.y;
    show();
  });
  const release = () => { grip = null; map.classList.remove("dragged"); };
  map.addEventListener("pointerup", release);
  map.addEventListener("pointercancel", release);
  map.addEventListener("dblclick", () => {
    view = { x: 0, y: 0, width: size.width, height: size.height };
    show();
  });

  document.querySelectorAll("[data-toggle]").forEach((box) => box.addEventListener("change", () => {
    map.querySelector(`[data-layer="${box.dataset.toggle}"]`).classList.toggle("off", !box.checked);
  }));
  document.querySelectorAll("[data-toggle-robot]").forEach((box) => box.addEventListener("change", () => {
    document.querySelectorAll(`svg [data-robot="${box.dataset.toggleRobot}"]`)
      .forEach((part) => part.classList.toggle("off", !box.checked));
  }));

  document.querySelectorAll("svg title").forEach((title) => {
    title.parentElement.dataset.tip = title.textContent;
    title.remove();
  });
  document.addEventListener("pointermove", (event) => {
    const part = event.target.closest ? event.target.closest("[data-tip]") : null;
    tip.hidden = !part || part.tagName === "svg";
    if (tip.hidden) return;
    tip.textContent = part.dataset.tip;
    tip.style.left = `${Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8)}px`;
    tip.style.top = `${Math.min(event.clientY + 16, innerHeight - tip.offsetHeight - 8)}px`;
  });

  const svg = (tag, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
    Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
    return made;
  };
  const scale = data.projection.scale;
  const pixel = (point) => [(point[0] - data.projection.west) * scale, (data.projection.north - point[1]) * scale];
  const dots = data.robots.map((robot, index) => {
    const dot = svg("circle", { class: "dot", r: 8, fill: robot.colour, "data-robot": index });
    map.append(dot);
    return dot;
  });
  const cursors = [...document.querySelectorAll("svg.chart")].map((chart) => {
    const line = svg("line", { class: "cursor", y1: 0, y2: chart.viewBox.baseVal.height });
    chart.append(line);
    return line;
  });

  const along = (points, part) => {
    const lengths = points.slice(1).map((p, i) => Math.hypot(p[0] - points[i][0], p[1] - points[i][1]));
    let left = part * lengths.reduce((sum, length) => sum + length, 0);
    for (let i = 0; i < lengths.length; i += 1) {
      if (left <= lengths[i] && lengths[i] > 0) {
        const f = left / lengths[i];
        return points[i].map((value, axis) => value + f * (points[i + 1][axis] - value));
      }
      left -= lengths[i];
    }
    return points[points.length - 1];
  };
  const timed = (leg, time) => {
    const i = Math.max(1, leg.times.findIndex((each) => each > time));
    const f = (time - leg.times[i - 1]) / Math.max(leg.times[i] - leg.times[i - 1], 1e-9);
    return leg.points[i - 1].map((value, axis) => value + f * (leg.points[i][axis] - value));
  };
  const within = (leg, time) => leg.times ? timed(leg, time)
    : along(leg.points, (time - leg.begin) / Math.max(leg.end - leg.begin, 1e-9));
  const positionOf = (robot, time) => {
    let at = robot.home;
    for (const leg of robot.legs) {
      if (time < leg.begin) break;
      at = time >= leg.end ? leg.points[leg.points.length - 1] : within(leg, time);
      if (time < leg.end) break;
    }
    return at;
  };
  const clock = (seconds) => {
    const s = Math.round(seconds);
    const two = (value) => String(value).padStart(2, "0");
    return s < 3600 ? `${Math.floor(s / 60)}:${two(s % 60)}`
      : `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
  };
  const moveTo = (time) => {
    data.robots.forEach((robot, index) => {
      const [x, y] = pixel(positionOf(robot, time));
      dots[index].setAttribute("cx", x);
      dots[index].setAttribute("cy", y);
    });
    const { left, right, end } = data.axis;
    const x = left + (right - left) * time / Math.max(end, 1e-9);
    cursors.forEach((line) => { line.setAttribute("x1", x); line.setAttribute("x2", x); });
    now.textContent = clock(time);
  };
  if (slider) slider.addEventListener("input", () => moveTo(Number(slider.value)));
  document.querySelectorAll("svg.chart").forEach((chart) => chart.addEventListener("click", (event) => {
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(chart.getScreenCTM().inverse());
    const part = (point.x - data.axis.left) / (data.axis.right - data.axis.left);
    slider.value = Math.min(Math.max(part, 0), 1) * data.axis.end;
    moveTo(Number(slider.value));
  }));

  let last = null;
  const step = (stamp) => {
    if (last === null) return;
    const speed = data.axis.end / 30;
    const time = Number(slider.value) + (stamp - last) / 1000 * speed;
    last = stamp;
    slider.value = Math.min(time, data.axis.end);
    moveTo(Number(slider.value));
    if (time < data.axis.end) requestAnimationFrame(step);
    else { last = null; play.textContent = "▶"; }
  };
  if (play) play.addEventListener("click", () => {
    if (last !== null) { last = null; play.textContent = "▶"; return; }
    if (Number(slider.value) >= data.axis.end) slider.value = 0;
    play.textContent = "❚❚";
    last = performance.now();
    requestAnimationFrame(step);
  });
  if (slider) moveTo(0);
  else dots.forEach((dot) => dot.remove());
})();
