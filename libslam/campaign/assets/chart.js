// Axes, scales and curves that the figures of a campaign are drawn with.
var chart = (function () {
  "use strict";
  var number = reportParts.number;
  var clips = 0;

  /// An empty drawing with axes. `spec`: width, height, x and y (scales), and where
  /// wanted left (margin), title, xLabel, whole (only whole numbers along x), names (rows instead of a y axis).
  function frame(parent, spec) {
    var margin = { left: spec.left || 58, right: 12, top: spec.title ? 26 : 10, bottom: spec.xLabel ? 40 : 24 };
    var width = spec.width - margin.left - margin.right, height = spec.height - margin.top - margin.bottom;
    spec.x.range([0, width]);
    spec.y.range([height, 0]);
    var svg = parent.append("svg").attr("viewBox", "0 0 " + spec.width + " " + spec.height);
    if (spec.title) svg.append("text").attr({ "class": "title", x: margin.left, y: 16 }).text(spec.title);
    var area = svg.append("g").attr("transform", "translate(" + margin.left + "," + margin.top + ")");
    var clip = "clip-" + clips++;
    area.append("clipPath").attr("id", clip).append("rect").attr({ width: width, height: height });
    area.append("g").attr({ "class": "axis", transform: "translate(0," + height + ")" })
      .call(axisOf(spec.x, "bottom", Math.max(3, width / 90), spec.whole).tickSize(-height, 0));
    if (!spec.names) area.append("g").attr("class", "axis").call(axisOf(spec.y, "left", Math.max(4, height / 45)).tickSize(-width, 0));
    var sheet = area.append("g").attr("clip-path", "url(#" + clip + ")");
    area.append("rect").attr({ "class": "frame", width: width, height: height });
    if (spec.xLabel)
      area.append("text").attr({ x: width / 2, y: height + 34, "text-anchor": "middle" }).text(spec.xLabel);
    return { area: area, sheet: sheet, width: width, height: height };
  }
  function isLog(scale) { return scale.base !== undefined; }
  function axisOf(scale, side, ticks, whole) {
    var axis = d3.svg.axis().scale(scale).orient(side).tickPadding(5);
    if (whole)
      return axis.tickValues(scale.ticks(ticks).filter(function (v) { return v % 1 === 0; })).tickFormat(d3.format("d"));
    if (!isLog(scale)) return axis.ticks(ticks);
    var values = reportParts.decades(scale.domain());
    if (values.length > ticks + 1)
      values = values.filter(function (v) {
        var decade = Math.log(v) / Math.LN10;
        return Math.abs(decade - Math.round(decade)) < 1e-9;
      });
    return axis.tickValues(values.length ? values : scale.domain()).tickFormat(function (v) { return String(+v.toPrecision(3)); });
  }
  /// Logarithmic where the values need it: positive, and the greatest far above the least.
  function scaleFor(values, factor, fromZero) {
    var extent = d3.extent(values.filter(function (v) { return v !== null && isFinite(v); }));
    if (extent[0] === undefined) extent = [0, 1];
    if (extent[0] > 0 && extent[1] > factor * extent[0])
      return d3.scale.log().domain([extent[0] / 1.2, extent[1] * 1.2]).clamp(true);
    var pad = 0.06 * (extent[1] - extent[0]) || 0.05 * Math.abs(extent[1]) || 1;
    return d3.scale.linear().domain([fromZero ? Math.min(0, extent[0]) : extent[0] - pad, extent[1] + pad]);
  }
  function curve(x, y, t, values) {
    return d3.svg.line().defined(function (i) { return values[i] !== null && (!isLog(y) || values[i] > 0); })
      .x(function (i) { return x(t[i]); }).y(function (i) { return y(values[i]); })(d3.range(t.length));
  }
  function nearest(t, time) {
    var i = d3.bisectLeft(t, time);
    return i > 0 && (i === t.length || time - t[i - 1] < t[i] - time) ? i - 1 : i;
  }
  /// A readout of `textAt(time)` under the mouse, with a line at that time.
  function followMouse(plot, x, textAt) {
    var cursor = plot.sheet.append("line").attr({ "class": "cursor", y1: 0, y2: plot.height }).style("display", "none");
    plot.area.append("rect").attr({ "class": "sheet", width: plot.width, height: plot.height })
      .on("mousemove", function () {
        var time = x.invert(d3.mouse(this)[0]);
        cursor.style("display", null).attr({ x1: x(time), x2: x(time) });
        reportParts.showReadout("time " + number(Math.round(time * 10) / 10) + " s\n" + textAt(time));
      })
      .on("mouseout", function () { cursor.style("display", "none"); reportParts.hideReadout(); });
  }
  function explain(node, text) {
    node.on("mousemove", function (d) { reportParts.showReadout(text(d)); }).on("mouseout", reportParts.hideReadout);
  }

  return { frame: frame, scaleFor: scaleFor, curve: curve, nearest: nearest, followMouse: followMouse, explain: explain };
})();
