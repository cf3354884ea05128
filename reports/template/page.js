// Sorts tables, lights up a curve, plays animations, and marks where the reader is. The page is whole without it.
(function () {
  "use strict";

  function value(cell) {
    if (cell.dataset.v !== undefined) return parseFloat(cell.dataset.v);
    return cell.classList.contains("number") ? null : cell.textContent.trim();
  }

  // Missing values stay at the end in either direction.
  function compare(a, b, sign) {
    if (a === null || b === null) return (a === null) - (b === null);
    if (typeof a === "number" && typeof b === "number") return sign * (a - b);
    return sign * String(a).localeCompare(String(b), "en", { numeric: true });
  }

  function sort(table, head) {
    var column = Array.prototype.indexOf.call(head.parentNode.children, head);
    var sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    var body = table.tBodies[0];
    var rows = Array.prototype.map.call(body.rows, function (row) {
      return { row: row, value: value(row.cells[column]) };
    });
    table.classList.add("sorted");
    rows.sort(function (a, b) { return compare(a.value, b.value, sign); });
    rows.forEach(function (entry) { body.appendChild(entry.row); });
    head.parentNode.querySelectorAll("th").forEach(function (th) { th.removeAttribute("aria-sort"); });
    head.setAttribute("aria-sort", sign === 1 ? "ascending" : "descending");
  }

  document.querySelectorAll("table.sortable").forEach(function (table) {
    table.querySelectorAll("thead th").forEach(function (head) {
      var button = document.createElement("button");
      button.type = "button";
      while (head.firstChild) button.appendChild(head.firstChild);
      head.appendChild(button);
      button.addEventListener("click", function () { sort(table, head); });
    });
  });

  document.querySelectorAll(".charts").forEach(function (charts) {
    // Curves of cases are the same in all plots of a study; those of runs are each plot's own.
    function pick(scope, name) {
      scope.classList.toggle("picking", name !== null);
      scope.querySelectorAll("[data-case]").forEach(function (part) {
        part.classList.toggle("on", part.dataset.case === name);
      });
    }
    charts.querySelectorAll("[data-case]").forEach(function (part) {
      var name = part.dataset.case, scope = name[0] === "-" ? part.closest("svg") : charts;
      if (part.tagName === "LI") part.tabIndex = 0;
      ["mouseenter", "focus"].forEach(function (event) {
        part.addEventListener(event, function () { pick(scope, name); });
      });
      ["mouseleave", "blur"].forEach(function (event) {
        part.addEventListener(event, function () { pick(scope, null); });
      });
    });
  });

  // A link to evidence that is folded up unfolds it.
  function unfold() {
    var target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (var part = target; part; part = part.parentElement) if (part.tagName === "DETAILS") part.open = true;
    if (target) target.scrollIntoView();
  }
  window.addEventListener("hashchange", unfold);
  if (location.hash) unfold();

  document.querySelectorAll(".command").forEach(function (command) {
    var button = document.createElement("button");
    button.type = "button";
    button.textContent = "Copy";
    button.addEventListener("click", function () {
      var code = command.querySelector("code");
      getSelection().selectAllChildren(code);
      var done = function () { button.textContent = "Copied"; };
      if (navigator.clipboard) navigator.clipboard.writeText(code.textContent).then(done, function () {});
      else if (document.execCommand("copy")) done();
      setTimeout(function () { button.textContent = "Copy"; }, 2000);
    });
    command.appendChild(button);
  });

  // Plays the sheets of a figure together, on a click alone: nothing moves by itself.
  document.querySelectorAll("[data-film]").forEach(function (figure) {
    var film = JSON.parse(figure.dataset.film), timer = null;
    var screens = figure.querySelectorAll(".screen img");
    var player = document.createElement("div"), button = document.createElement("button");
    var slider = document.createElement("input"), time = document.createElement("output");
    player.className = "player";
    player.setAttribute("role", "group");
    player.setAttribute("aria-label", "Animation");
    button.type = "button";
    slider.type = "range";
    slider.min = 0;
    slider.max = film.count - 1;
    slider.setAttribute("aria-label", "Instant");
    time.setAttribute("aria-live", "off");
    function show(k) {
      slider.value = k;
      time.textContent = film.times[k];
      slider.setAttribute("aria-valuetext", film.times[k]);
      screens.forEach(function (image) {
        var across = +image.dataset.across;
        var n = film.count > 1 ? Math.round(k / (film.count - 1) * (image.dataset.count - 1)) : 0;
        image.style.left = -100 * (n % across) + "%";
        image.style.top = -100 * Math.floor(n / across) + "%";
      });
    }
    function stop() {
      clearInterval(timer);
      timer = null;
      button.textContent = "▶ Play";
    }
    button.addEventListener("click", function () {
      if (timer) return stop();
      if (+slider.value >= film.count - 1) show(0);
      button.textContent = "❚❚ Pause";
      timer = setInterval(function () {
        show(+slider.value + 1);
        if (+slider.value >= film.count - 1) stop();
      }, 1000 * film.seconds / film.count);
    });
    slider.addEventListener("input", function () { stop(); show(+slider.value); });
    stop();
    show(film.count - 1);
    player.append(button, slider, time);
    figure.querySelector(".panel").after(player);
  });

  if ("IntersectionObserver" in window) {
    var links = {};
    document.querySelectorAll(".contents a").forEach(function (a) { links[a.hash.slice(1)] = a; });
    var watch = new IntersectionObserver(function (entries) {
      entries.forEach(function (entry) {
        if (!entry.isIntersecting) return;
        Object.keys(links).forEach(function (id) {
          links[id].classList.toggle("here", id === entry.target.id);
        });
      });
    }, { rootMargin: "-10% 0px -80% 0px" });
    document.querySelectorAll("main > section").forEach(function (s) { watch.observe(s); });
  }
})();
