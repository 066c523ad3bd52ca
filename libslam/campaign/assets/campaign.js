// Draws the numbers of #data into #plots: the grid, then the chosen point with its filters.
(function () {
  "use strict";
  var data = reportParts.data, main = reportParts.main, number = reportParts.number;
  var GAP = 14, SECTION_PADDING = 34;
  var chosen = 0;
  var frame = chart.frame, scaleFor = chart.scaleFor, curve = chart.curve, nearest = chart.nearest;
  var followMouse = chart.followMouse, explain = chart.explain;

  function colour(variant) { return "var(--series-" + variant % 8 + ")"; }
  function paint(node, property, variant) {
    node.style(property, colour(variant)).style("stroke-dasharray", variant < 8 ? null : "5 3");
  }
  function contentWidth() { return Math.max(280, main.node().clientWidth - SECTION_PADDING); }
  function columnWidth(columns) {
    var fitting = Math.max(1, Math.min(columns, Math.floor((contentWidth() + GAP) / (300 + GAP))));
    return Math.floor((contentWidth() - (fitting - 1) * GAP) / fitting);
  }
  /// What `find` returns of each cell of the chosen point that has it, with the number of its variant.
  function series(cells, find) {
    return cells.map(function (cell, v) { return { variant: v, cell: cell, value: cell && find(cell) }; })
      .filter(function (s) { return s.value; });
  }
  function keysOf(list) {
    return list.map(function (s) {
      return { text: data.variants[s.variant], colour: "series-" + s.variant % 8, shape: s.variant < 8 ? "" : "key-dashed" };
    });
  }
  function note(plot, text) { plot.append("p").attr("class", "note").text(text); }

  // ---- the grid -----------------------------------------------------------------------------------------

  var GRID_FIGURES = [
    { title: "position RMSE [m], median and quartiles", level: null,
      of: function (c) { var b = c.boxes.position; return b && { low: b[2], value: b[3], high: b[4] }; } },
    { title: "position error / reference, 95 % interval", level: 1,
      of: function (c) { return c.ratio && { low: c.ratio.lower, value: c.ratio.value, high: c.ratio.upper }; } },
    { title: "mean NEES", level: 3,
      of: function (c) { return c.nees_mean !== null && { low: c.nees_mean, value: c.nees_mean, high: c.nees_mean }; } }
  ];
  function gridSpots(figure) {
    var spots = [];
    data.points.forEach(function (point, p) {
      series(point.cells, figure.of).forEach(function (s) {
        spots.push({ point: p, variant: s.variant, at: data.grid.values ? data.grid.values[p] : p + 1, value: s.value });
      });
    });
    return spots;
  }
  function drawGridFigure(parent, figure) {
    var spots = gridSpots(figure);
    if (!spots.length) return;
    var heights = d3.merge(spots.map(function (s) { return [s.value.low, s.value.high]; }));
    if (figure.level) heights.push(figure.level);
    var abscissas = data.grid.values || d3.range(1, data.points.length + 1);
    var x = scaleFor(abscissas, 50, false), y = scaleFor(heights, 10, true);
    var plot = frame(parent, { width: columnWidth(3), height: 270, x: x, y: y, title: figure.title,
      xLabel: data.grid.values ? data.grid.name : "number of the grid point", whole: !data.grid.values });
    if (figure.level)
      plot.sheet.append("line").attr({ "class": "level-line", x1: 0, x2: plot.width, y1: y(figure.level), y2: y(figure.level) });
    data.variants.forEach(function (name, v) {
      var own = spots.filter(function (s) { return s.variant === v; }).sort(function (a, b) { return a.at - b.at; });
      // Side by side: intervals of equal points must not hide each other.
      function left(s) { return x(s.at) + (v - (data.variants.length - 1) / 2) * 4; }
      if (data.grid.values)
        paint(plot.sheet.append("path").attr("class", "series").attr("d", own.length ? d3.svg.line().x(left)
          .y(function (s) { return y(s.value.value); })(own) : null), "stroke", v);
      paint(plot.sheet.selectAll(".interval-" + v).data(own).enter().append("line").attr({ "class": "whisker",
        x1: left, x2: left, y1: function (s) { return y(s.value.low); }, y2: function (s) { return y(s.value.high); } }),
        "stroke", v);
      var marks = plot.sheet.selectAll(".mark-" + v).data(own).enter().append("circle")
        .attr({ "class": "mark spot", r: 4.2, cx: left, cy: function (s) { return y(s.value.value); } })
        .on("click", function (s) { reportParts.hideReadout(); choose(s.point); });
      paint(marks, "fill", v);
      explain(marks, function (s) {
        var interval = s.value.low === s.value.high ? "" : "  [" + number(s.value.low) + ", " + number(s.value.high) + "]";
        return data.points[s.point].label + "\n" + name + "  " + number(s.value.value) + interval;
      });
    });
  }
  function drawGrid() {
    var plot = reportParts.section(main, "Over the grid",
      "Flat, low curves belong to filters that the varied setting does not hurt: the ratio should lie below 1 (dashed) with its " +
      "whole interval, the mean NEES near 3 (dashed). Click a dot to see its grid point below.");
    reportParts.legend(plot, keysOf(data.variants.map(function (n, v) { return { variant: v }; })));
    var multiples = plot.append("div").attr("class", "multiples");
    GRID_FIGURES.forEach(function (figure) { drawGridFigure(multiples, figure); });
    if (multiples.select("svg").empty()) note(plot, "No run is done yet.");
  }
  function drawSelector() {
    var select = main.append("div").attr("class", "selector").append("label").text("Grid point ").append("select");
    select.selectAll("option").data(data.points).enter().append("option")
      .text(function (p, i) { return i + 1 + ": " + p.label; })
      .property("selected", function (p, i) { return i === chosen; });
    select.on("change", function () { choose(this.selectedIndex); });
  }

  // ---- one grid point -----------------------------------------------------------------------------------

  function missingCurves(plot, reason) {
    note(plot, data.curves ? reason
      : "The campaign has too many cells to show curves; campaign.json holds them.");
  }
  function drawNees(cells) {
    var plot = reportParts.section(main, "Consistency: mean NEES over time",
      "The squared pose error in units of the filter's own covariance, averaged over the runs of the first batch: it should move " +
      "around 3 and stay inside the band nearly always. Above the band the filter claims more certainty than it has, below less.");
    var list = series(cells, function (c) { return c.nees; });
    if (!list.length) return missingCurves(plot, "No run of this point is done.");
    var bands = d3.map();
    list.forEach(function (s) { bands.set(s.value.runs, s.value); });
    var names = bands.values().map(function (b) {
      return { text: "95 % of consistent filters, " + b.runs + (b.runs === 1 ? " run" : " runs"), colour: "band", shape: "key-band" };
    });
    reportParts.legend(plot, keysOf(list).concat(names, [{ text: "ideal mean 3", colour: "level", shape: "key-dashed" }]));
    var upper = d3.max(list, function (s) { return s.value.upper; }), lower = d3.min(list, function (s) { return s.value.lower; });
    var greatest = d3.max(list, function (s) { return d3.max(s.value.mean); });
    var x = d3.scale.linear().domain(d3.extent(d3.merge(list.map(function (s) { return d3.extent(s.value.t); }))));
    var y = greatest > 4 * upper ? d3.scale.log().domain([lower / 4, greatest * 1.3]).clamp(true)
      : d3.scale.linear().domain([0, 1.08 * Math.max(upper, greatest || 0)]);
    var drawing = frame(plot, { width: contentWidth(), height: 330, x: x, y: y, xLabel: "time [s]" });
    bands.values().forEach(function (b) {
      drawing.sheet.append("rect").attr({ "class": "band-area", width: drawing.width, y: y(b.upper), height: y(b.lower) - y(b.upper) });
    });
    drawing.sheet.append("line").attr({ "class": "level-line", x2: drawing.width, y1: y(3), y2: y(3) });
    list.forEach(function (s) {
      paint(drawing.sheet.append("path").attr({ "class": "series", d: curve(x, y, s.value.t, s.value.mean) }), "stroke", s.variant);
    });
    if (list.some(function (s) { return s.value.mean.slice(1).some(function (v) { return v === null; }); }))
      plot.append("p").attr("class", "good").text("Gaps: no run was corrected at that time, usually because no landmark was in sight. " +
        "Beside a gap few runs count, so that a consistent curve swings further than the band of all runs.");
    followMouse(drawing, x, function (time) {
      return list.map(function (s) {
        return data.variants[s.variant] + "  " + number(s.value.mean[nearest(s.value.t, time)]);
      }).join("\n");
    });
  }

  function drawError(parent, e, title, variant) {
    var low = e.bound.map(function (b) { return b === null ? null : -b; });
    var x = d3.scale.linear().domain(d3.extent(e.t));
    var y = d3.scale.linear().domain(reportParts.valueExtent(
      { low: e.error, high: e.error, band: { low: low, high: e.bound } }, function () { return true; }));
    var drawing = frame(parent, { width: columnWidth(3), height: 170, x: x, y: y, title: title });
    var band = d3.svg.area().defined(function (i) { return low[i] !== null; }).x(function (i) { return x(e.t[i]); })
      .y0(function (i) { return y(low[i]); }).y1(function (i) { return y(e.bound[i]); });
    drawing.sheet.append("path").attr({ "class": "band-area", d: band(d3.range(e.t.length)) });
    drawing.sheet.append("line").attr({ "class": "zero", x2: drawing.width, y1: y(0), y2: y(0) });
    paint(drawing.sheet.append("path").attr({ "class": "error-line", d: curve(x, y, e.t, e.error) }), "stroke", variant);
    followMouse(drawing, x, function (time) {
      var i = nearest(e.t, time);
      return title + " " + number(e.error[i]) + "\n\u00b13\u03c3 " + number(e.bound[i]);
    });
  }
  function drawErrors(cells) {
    var plot = reportParts.section(main, "Error against \u00b13\u03c3, one run",
      "The first run" + (data.seed === null ? "" : " (seed " + data.seed + ")") + ", over the time in seconds: the error should " +
      "stay inside the band nearly always, and use it. A curve outside is an error that the filter believes impossible. Every " +
      "drawing has a scale of its own.");
    var list = series(cells, function (c) { return c.errors; });
    if (!list.length) return missingCurves(plot, "The first run of this point has no result.");
    reportParts.legend(plot, [{ text: "\u00b13\u03c3 of the filter", colour: "band", shape: "key-band" }]);
    list.forEach(function (s) {
      plot.append("h3").attr("class", "variant").text(data.variants[s.variant]).node().style.setProperty("--key", colour(s.variant));
      var multiples = plot.append("div").attr("class", "multiples");
      ["x error [m]", "y error [m]", "heading error [\u00b0]"].forEach(function (title, i) {
        drawError(multiples, s.value[i], title, s.variant);
      });
    });
  }

  function drawBox(plot, x, top, s) {
    var b = s.value, group = plot.sheet.append("g"), middle = top + 12;
    function line(name, x1, x2, y1, y2) {
      paint(group.append("line").attr({ "class": name, x1: x(x1), x2: x(x2), y1: y1, y2: y2 }), "stroke", s.variant);
    }
    line("whisker", b[1], b[2], middle, middle);
    line("whisker", b[4], b[5], middle, middle);
    line("whisker", b[1], b[1], top + 7, top + 17);
    line("whisker", b[5], b[5], top + 7, top + 17);
    paint(group.append("rect").attr({ "class": "box", x: x(b[2]), width: Math.max(1, x(b[4]) - x(b[2])), y: top + 3, height: 18 })
      .style("fill", colour(s.variant)), "stroke", s.variant);
    line("median", b[3], b[3], top + 3, top + 21);
    [b[0], b[6]].forEach(function (v) {
      group.append("circle").attr({ "class": "mark", r: 2.6, cx: x(v), cy: middle }).style("fill", colour(s.variant));
    });
    explain(group.append("rect").attr({ "class": "sheet", width: plot.width, y: top, height: 24 }), function () {
      return data.variants[s.variant] + ", " + s.cell.done + " runs\nmedian " + number(b[3]) + "\nquartiles " + number(b[2]) +
        " \u2026 " + number(b[4]) + "\n5 % \u2026 95 % " + number(b[1]) + " \u2026 " + number(b[5]) +
        "\nleast, greatest " + number(b[0]) + ", " + number(b[6]);
    });
  }
  function drawBoxes(cells) {
    var plot = reportParts.section(main, "Every run by itself",
      "Each run gives one value. Box: the middle half of the runs with the median; whiskers: from 5 % to 95 %; dots: the least and " +
      "the greatest. Errors should lie far to the left and close together, NEES around 3 (dashed); a dot far to the right is a run that went wrong.");
    var multiples = plot.append("div").attr("class", "multiples");
    [["position", "position RMSE [m]", null], ["heading", "heading RMSE [\u00b0]", null], ["nees", "mean NEES of the run", 3]]
      .forEach(function (figure) {
        var list = series(cells, function (c) { return c.boxes[figure[0]]; });
        if (!list.length) return;
        var values = d3.merge(list.map(function (s) { return s.value; }));
        if (figure[2]) values.push(figure[2]);
        var x = scaleFor(values, 15, true), longest = d3.max(list, function (s) { return data.variants[s.variant].length; });
        var drawing = frame(multiples, { width: columnWidth(3), height: 58 + 28 * list.length, title: figure[1], names: true,
          left: Math.min(120, 16 + 7 * longest), x: x, y: d3.scale.linear() });
        if (figure[2])
          drawing.sheet.append("line").attr({ "class": "level-line", x1: x(3), x2: x(3), y2: drawing.height });
        list.forEach(function (s, i) {
          var name = data.variants[s.variant], top = 2 + 28 * i;
          drawing.area.append("text").attr({ x: -7, y: top + 16, "text-anchor": "end" })
            .text(name.length > 15 ? name.slice(0, 14) + "\u2026" : name);
          drawBox(drawing, x, top, s);
        });
      });
    if (multiples.select("svg").empty()) note(plot, "No run of this point is done.");
  }

  function draw() {
    main.selectAll("*").remove();
    if (!data.points.length) return note(main, "The campaign has no cells.");
    if (data.grid) {
      drawGrid();
      drawSelector();
    }
    var cells = data.points[chosen].cells;
    drawNees(cells);
    drawErrors(cells);
    drawBoxes(cells);
    d3.selectAll("tbody").classed("selected", function (d, i) { return i === chosen && data.points.length > 1; });
  }
  function choose(point) {
    chosen = point;
    var at = window.pageYOffset;
    draw();
    window.scrollTo(0, at);
  }

  var width = 0;
  function fit() {
    if (main.node().clientWidth === width) return;
    width = main.node().clientWidth;
    draw();
  }
  window.addEventListener("resize", fit);
  fit();
})();
