// Draws the numbers of #data into #plots: a map with equal axes, then time series that zoom together.
(function () {
  "use strict";
  var data = reportParts.data, main = reportParts.main;
  var showReadout = reportParts.showReadout, hideReadout = reportParts.hideReadout;
  var number = reportParts.number, isValue = reportParts.isValue, legend = reportParts.legend;
  var valueExtent = reportParts.valueExtent, decades = reportParts.decades;
  var WIDTH = 1200;

  // ---- map ----------------------------------------------------------------------------------------------

  /// Half axes and angle of the 95 % ellipse of a covariance.
  function ellipseOf(xx, xy, yy) {
    var mean = (xx + yy) / 2, spread = Math.sqrt(Math.pow((xx - yy) / 2, 2) + xy * xy);
    return {
      major: data.map.ellipse_scale * Math.sqrt(Math.max(0, mean + spread)),
      minor: data.map.ellipse_scale * Math.sqrt(Math.max(0, mean - spread)),
      angle: 0.5 * Math.atan2(2 * xy, xx - yy) * 180 / Math.PI
    };
  }

  function mapExtent(map) {
    var xs = map.path.x.concat(map.truth.x), ys = map.path.y.concat(map.truth.y);
    map.landmarks.concat(map.true_landmarks).forEach(function (l) { xs.push(l[0]); ys.push(l[1]); });
    (map.walls || []).forEach(function (w) { xs.push(w[0], w[2]); ys.push(w[1], w[3]); });
    return { x: d3.extent(xs), y: d3.extent(ys) };
  }

  /// `vertical`: the axis in the place of y; `lowest`: height of a flat view in pixels.
  function drawMap(map, title, vertical, lowest) {
    var extent = mapExtent(map);
    if (extent.x[0] === undefined) return;
    var clip = "map-clip-" + vertical;
    var hasTruth = map.truth.x.length > 0, hasTrueMap = map.true_landmarks.length > 0;
    var plot = reportParts.section(main, title, hasTruth || hasTrueMap
      ? "The estimated path should lie on the true one, and nearly every true landmark (cross) inside its 95 % ellipse."
      : map.walls ? "Walls should be single straight lines: a wall that was mapped twice is a loop that did not close."
      : "Ellipses hold the true place with 95 % probability; they should shrink when the robot comes back to known ground.");
    var entries = [{ text: map.walls ? "estimated path" : "estimated path and landmarks, 95 % ellipses", colour: "estimate" }];
    if (map.smoothed) entries.push({ text: "path as known at the end", colour: "level" });
    if (map.walls) entries.push({ text: "walls", colour: "ink" });
    if (hasTruth || hasTrueMap) entries.push({ text: "truth", colour: "truth" });
    if (map.events) entries.push({ text: "event", colour: "event" });
    legend(plot, entries);

    var margin = { left: 62, right: 14, top: 8, bottom: 40 };
    var width = WIDTH - margin.left - margin.right;
    var spanX = Math.max(extent.x[1] - extent.x[0], 0.1) * 1.08, spanY = Math.max(extent.y[1] - extent.y[0], 0.1) * 1.08;
    var height = Math.max(lowest, Math.min(820, width * spanY / spanX));
    var metres = Math.max(spanX / width, spanY / height);
    var centre = [(extent.x[0] + extent.x[1]) / 2, (extent.y[0] + extent.y[1]) / 2];
    var x = d3.scale.linear().range([0, width])
      .domain([centre[0] - metres * width / 2, centre[0] + metres * width / 2]);
    var y = d3.scale.linear().range([height, 0])
      .domain([centre[1] - metres * height / 2, centre[1] + metres * height / 2]);

    var svg = plot.append("svg").attr("viewBox", "0 0 " + WIDTH + " " + (height + margin.top + margin.bottom));
    var area = svg.append("g").attr("transform", "translate(" + margin.left + "," + margin.top + ")");
    area.append("clipPath").attr("id", clip).append("rect").attr({ width: width, height: height });
    var xAxis = area.append("g").attr({ "class": "axis", transform: "translate(0," + height + ")" });
    var yAxis = area.append("g").attr("class", "axis");
    area.append("rect").attr({ "class": "frame", width: width, height: height });
    area.append("text").attr({ x: width / 2, y: height + 34, "text-anchor": "middle" }).text("x [m]");
    area.append("text").attr({ transform: "translate(-48," + height / 2 + ") rotate(-90)", "text-anchor": "middle" })
      .text(vertical + " [m]");
    var sheet = area.append("g").attr("clip-path", "url(#" + clip + ")");
    sheet.append("rect").attr({ "class": "sheet", width: width, height: height });
    var layer = { path: sheet.append("g"), truth: sheet.append("g"), marks: sheet.append("g") };

    var line = d3.svg.line().x(function (p) { return x(p[0]); }).y(function (p) { return y(p[1]); });
    var truthPoints = d3.zip(map.truth.x, map.truth.y), pathPoints = d3.zip(map.path.x, map.path.y);
    var truthLine = layer.truth.append("path").attr("class", "truth-line");
    var truthDots = layer.truth.selectAll(".truth-dot").data(map.truth_is_sparse ? truthPoints : [])
      .enter().append("circle").attr({ "class": "truth-dot", r: 1.6 });
    var pathLine = layer.path.append("path").attr("class", "estimate-line");
    var smoothedPoints = map.smoothed ? d3.zip(map.smoothed.x, map.smoothed.y) : [];
    var smoothedLine = layer.path.append("path").attr("class", "smoothed-line");
    var walls = layer.marks.selectAll(".wall").data(map.walls || []).enter().append("line").attr("class", "wall")
      .on("mousemove", function (w) {
        showReadout("wall " + w[4] + ", seen " + w[5] + " times\nlength " +
          number(Math.sqrt(Math.pow(w[2] - w[0], 2) + Math.pow(w[3] - w[1], 2))) + " m");
      }).on("mouseout", hideReadout);
    var poses = layer.path.selectAll(".pose-ellipse").data(map.pose_ellipses).enter()
      .append("ellipse").attr("class", "pose-ellipse");
    var landmarks = layer.marks.selectAll(".landmark-ellipse").data(map.landmarks).enter()
      .append("ellipse").attr("class", "landmark-ellipse")
      .on("mousemove", function (l) {
        var e = ellipseOf(l[2], l[3], l[4]);
        showReadout("landmark " + l[5] + ", seen " + l[6] + " times\nx " + number(l[0]) + " m, " + vertical + " " + number(l[1]) +
          " m\n95 % half axes " + number(e.major) + ", " + number(e.minor) + " m");
      }).on("mouseout", hideReadout);
    var dots = layer.marks.selectAll(".estimate-dot").data(map.landmarks).enter()
      .append("circle").attr({ "class": "estimate-dot", r: 1.8 }).style("pointer-events", "none");
    var crosses = layer.marks.selectAll(".truth-cross").data(map.true_landmarks).enter()
      .append("path").attr({ "class": "truth-cross", d: "M-4,-4L4,4M-4,4L4,-4" })
      .on("mousemove", function (l) {
        showReadout("true landmark " + l[2] + "\nx " + number(l[0]) + " m, " + vertical + " " + number(l[1]) + " m");
      }).on("mouseout", hideReadout);
    var events = layer.marks.selectAll(".event-mark").data(map.events || []).enter()
      .append("circle").attr({ "class": "event-mark", r: 7 })
      .on("mousemove", function (e) { showReadout(e[2]); }).on("mouseout", hideReadout);
    var ends = layer.marks.selectAll(".end-mark")
      .data(pathPoints.length ? [pathPoints[0], pathPoints[pathPoints.length - 1]] : []).enter()
      .append("circle").attr({ r: 5, "class": function (p, i) { return i ? "end" : "start"; } });
    ends.append("title").text(function (p, i) { return i ? "end" : "start"; });

    function place(p) { return "translate(" + x(p[0]) + "," + y(p[1]) + ")"; }
    function drawEllipse(e) {
      var axes = ellipseOf(e[2], e[3], e[4]), pixels = Math.abs(x(1) - x(0));
      d3.select(this).attr({
        rx: Math.max(axes.major * pixels, 0.5), ry: Math.max(axes.minor * pixels, 0.5),
        transform: place(e) + " rotate(" + -axes.angle + ")"
      });
    }
    function redraw() {
      xAxis.call(d3.svg.axis().scale(x).orient("bottom").ticks(10).tickSize(-height, 0));
      yAxis.call(d3.svg.axis().scale(y).orient("left").ticks(Math.max(4, height / 80)).tickSize(-width, 0));
      truthLine.attr("d", map.truth_is_sparse || !truthPoints.length ? null : line(truthPoints));
      truthDots.attr("transform", place);
      pathLine.attr("d", pathPoints.length ? line(pathPoints) : null);
      smoothedLine.attr("d", smoothedPoints.length ? line(smoothedPoints) : null);
      walls.attr({ x1: function (w) { return x(w[0]); }, y1: function (w) { return y(w[1]); },
        x2: function (w) { return x(w[2]); }, y2: function (w) { return y(w[3]); } });
      poses.each(drawEllipse);
      landmarks.each(drawEllipse);
      dots.attr("transform", place);
      crosses.attr("transform", place);
      ends.attr("transform", place);
      events.attr("transform", place);
    }
    var zoom = d3.behavior.zoom().x(x).y(y).scaleExtent([0.5, 5000]).on("zoom", redraw);
    sheet.call(zoom);
    plot.append("button").text("Reset view").on("click", function () {
      zoom.translate([0, 0]).scale(1);
      redraw();
    });
    redraw();
  }

  // ---- time series --------------------------------------------------------------------------------------

  var timeExtent = d3.extent(d3.merge(data.plots.map(function (p) { return d3.extent(p.t); })));
  var redrawers = [];
  function zoomTime(extent) {
    redrawers.forEach(function (redraw) { redraw(extent); });
  }

  function drawPanel(plot, t, panel, isLast, clipId) {
    var margin = { left: 76, right: 14, top: 10, bottom: isLast ? 40 : 12 };
    var width = WIDTH - margin.left - margin.right, height = 150;
    var x = d3.scale.linear().range([0, width]);
    var y = (panel.log ? d3.scale.log().clamp(true) : d3.scale.linear()).range([height, 0]);
    var svg = plot.append("svg").attr("viewBox", "0 0 " + WIDTH + " " + (height + margin.top + margin.bottom));
    var area = svg.append("g").attr("transform", "translate(" + margin.left + "," + margin.top + ")");
    area.append("clipPath").attr("id", clipId).append("rect").attr({ width: width, height: height });
    var xAxis = area.append("g").attr({ "class": "axis", transform: "translate(0," + height + ")" });
    var yAxis = area.append("g").attr("class", "axis");
    var sheet = area.append("g").attr("clip-path", "url(#" + clipId + ")");
    area.append("rect").attr({ "class": "frame", width: width, height: height });
    area.append("text").attr({ transform: "translate(-62," + height / 2 + ") rotate(-90)", "text-anchor": "middle" })
      .text(panel.label + (panel.unit ? " [" + panel.unit + "]" : ""));
    if (isLast) area.append("text").attr({ x: width / 2, y: height + 34, "text-anchor": "middle" })
      .text(data.axis.name + (data.axis.unit ? " [" + data.axis.unit + "]" : ""));

    var floor = 1e-300;
    function height_of(v) { return y(panel.log ? Math.max(v, floor) : v); }
    function areaOf(low, high) {
      return d3.svg.area().defined(function (i) { return isValue(low[i]) && isValue(high[i]); })
        .x(function (i) { return x(t[i]); })
        .y0(function (i) { return height_of(low[i]); }).y1(function (i) { return height_of(high[i]); });
    }
    var indices = d3.range(t.length);
    var meanLine = d3.svg.line().defined(function (i) { return isValue(panel.mean[i]); })
      .x(function (i) { return x(t[i]); }).y(function (i) { return height_of(panel.mean[i]); });
    var band = panel.band ? sheet.append("path").attr("class", panel.mean ? "band-area is-cloud" : "band-area") : null;
    var interval = panel.interval ? sheet.append("rect").attr("class", "band-area") : null;
    var curve = sheet.append("path").attr("class", panel.mean ? "estimate-area is-cloud" : "estimate-area");
    var mean = panel.mean ? sheet.append("path").attr("class", "mean-line") : null;
    var level = panel.level ? sheet.append("line").attr("class", "level-line") : null;
    var happened = sheet.selectAll(".event-line").data(data.events || []).enter()
      .append("line").attr({ "class": "event-line", y1: 0, y2: height });
    var cursor = sheet.append("line").attr({ "class": "cursor", y1: 0, y2: height }).style("display", "none");

    function redraw(extent) {
      x.domain(extent);
      y.domain(valueExtent(panel, function (i) { return t[i] >= extent[0] && t[i] <= extent[1]; }));
      xAxis.call(d3.svg.axis().scale(x).orient("bottom").ticks(12).tickSize(-height, 0)
        .tickFormat(isLast ? null : function () { return ""; }));
      var axis = d3.svg.axis().scale(y).orient("left").tickSize(-width, 0);
      yAxis.call(panel.log ? axis.tickValues(decades(y.domain())).tickFormat(d3.format("g")) : axis.ticks(5));
      if (band) band.attr("d", areaOf(panel.band.low, panel.band.high)(indices));
      if (interval) interval.attr({ x: 0, width: width, y: y(panel.interval.high),
        height: y(panel.interval.low) - y(panel.interval.high) });
      curve.attr("d", areaOf(panel.low, panel.high)(indices));
      if (mean) mean.attr("d", meanLine(indices));
      happened.attr({ x1: function (e) { return x(e.t); }, x2: function (e) { return x(e.t); } });
      if (level) level.attr({ x1: 0, x2: width, y1: y(panel.level.value), y2: y(panel.level.value) });
    }
    redrawers.push(redraw);

    var brush = d3.svg.brush().x(x).on("brushend", function () {
      var extent = brush.empty() ? null : brush.extent();
      area.select(".selection").call(brush.clear());
      if (extent) zoomTime(extent);
    });
    var selection = area.append("g").attr("class", "selection").call(brush);
    selection.selectAll("rect").attr("height", height);
    selection.on("dblclick", function () { zoomTime(timeExtent); })
      .on("mousemove.readout", function () {
        var i = Math.max(0, d3.bisectRight(t, x.invert(d3.mouse(area.node())[0])) - 1);
        cursor.style("display", null).attr({ x1: x(t[i]), x2: x(t[i]) });
        var low = panel.low[i], high = panel.high[i];
        var text = data.axis.name + " " + number(t[i]) + " " + data.axis.unit + "\n" + panel.label + " " +
          (low === high ? number(low) : number(low) + " \u2026 " + number(high)) + (panel.unit === "1" ? "" : " " + panel.unit);
        if (panel.band) text += "\n" + panel.band.name + " " + number(panel.band.low[i]) + " \u2026 " + number(panel.band.high[i]);
        showReadout(text);
      })
      .on("mouseout.readout", function () { cursor.style("display", "none"); hideReadout(); });
  }

  function drawPlot(plotData, index) {
    var plot = reportParts.section(main, plotData.title, plotData.good);
    var first = plotData.panels[0];
    var entries = [{ text: plotData.value, colour: "estimate" }];
    if (first.mean) entries.push({ text: "moving mean", colour: "mean" });
    if (first.band || first.interval)
      entries.push({ text: (first.band || first.interval).name, colour: "band", shape: "key-band" });
    var withLevel = plotData.panels.filter(function (p) { return p.level; })[0];
    if (withLevel) entries.push({ text: withLevel.level.name, colour: "level", shape: "key-dashed" });
    if (data.events) entries.push({ text: "event", colour: "event", shape: "key-dashed" });
    legend(plot, entries);
    plot.append("button").text("Whole run").on("click", function () { zoomTime(timeExtent); });
    plotData.panels.forEach(function (panel, i) {
      drawPanel(plot, plotData.t, panel, i === plotData.panels.length - 1, "clip-" + index + "-" + i);
    });
  }

  drawMap(data.map, "Path and map", "y", 360);
  if (data.side) drawMap(data.side, "From the side", "z", 160);
  data.plots.forEach(drawPlot);
  if (timeExtent[0] !== undefined) {
    if (timeExtent[0] === timeExtent[1]) timeExtent = [timeExtent[0] - 0.5, timeExtent[1] + 0.5];
    zoomTime(timeExtent);
    main.append("p").attr("class", "good")
      .text("Drag across a time plot to zoom all of them, double-click to see the whole run; the map zooms with the wheel.");
  }
})();
