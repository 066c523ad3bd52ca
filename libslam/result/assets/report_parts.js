// What the pages of a run and of a campaign draw with: readout, sections, legends, extents.
var reportParts = (function () {
  "use strict";
  var readout = d3.select("body").append("div").attr("class", "readout");

  function showReadout(text) {
    var event = d3.event;
    var left = Math.min(event.clientX + 14, window.innerWidth - 260);
    readout.style({ display: "block", left: left + "px", top: event.clientY + 16 + "px" }).text(text);
  }
  function hideReadout() { readout.style("display", "none"); }
  function number(value) { return value === null || value === undefined ? "\u2013" : d3.format(".5g")(value); }
  function isValue(value) { return value !== null; }

  function section(parent, title, sentence) {
    var plot = parent.append("section").attr("class", "plot");
    plot.append("h2").text(title);
    plot.append("p").attr("class", "good").text(sentence);
    return plot;
  }
  function legend(plot, entries) {
    var keys = plot.append("div").attr("class", "legend").selectAll("span").data(entries).enter().append("span");
    keys.text(function (e) { return e.text; })
      .attr("class", function (e) { return e.shape || ""; });
    keys.each(function (e) { this.style.setProperty("--key", "var(--" + e.colour + ")"); });
  }

  function valueExtent(panel, inside) {
    var values = [];
    function take(series) { series.forEach(function (v, i) { if (isValue(v) && inside(i)) values.push(v); }); }
    take(panel.low);
    take(panel.high);
    var own = d3.extent(values);
    if (panel.level) values.push(panel.level.value);
    if (panel.interval) values.push(panel.interval.low, panel.interval.high);
    if (panel.band) {
      // A band that starts wide must not flatten the curve: it may at most triple the range of the values.
      // Around a constant it gives the scale.
      var range = own[1] - own[0];
      var reach = panel.log || range < 1e-9 * Math.abs(own[1]) + 1e-12 ? Infinity : 1.5 * range;
      panel.band.low.concat(panel.band.high).forEach(function (v, i) {
        if (isValue(v) && inside(i % panel.band.low.length))
          values.push(Math.max(own[0] - reach, Math.min(own[1] + reach, v)));
      });
    }
    if (panel.log) values = values.filter(function (v) { return v > 0; });
    if (!values.length) return [0.1, 1];
    var extent = d3.extent(values);
    if (panel.log) {
      // Single steps at almost zero say nothing: four decades are enough.
      return [Math.max(extent[0], extent[1] * 1e-4) / 1.2, extent[1] * 1.2];
    }
    var pad = 0.06 * (extent[1] - extent[0]) || Math.abs(extent[0]) * 0.01 || 1;
    return [extent[0] - pad, extent[1] + pad];
  }

  /// Powers of ten inside a domain; with few of them also multiples.
  function decades(domain) {
    var ticks = [], first = Math.floor(Math.log(domain[0]) / Math.LN10), last = Math.ceil(Math.log(domain[1]) / Math.LN10);
    function fill(factors) {
      ticks = [];
      for (var p = first; p <= last; ++p)
        factors.forEach(function (f) {
          var v = f * Math.pow(10, p);
          if (v >= domain[0] && v <= domain[1]) ticks.push(v);
        });
    }
    fill(last - first > 3 ? [1] : [1, 2, 5]);
    if (ticks.length < 2) fill([1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]);
    return ticks;
  }

  return {
    data: JSON.parse(document.getElementById("data").textContent), main: d3.select("#plots"),
    showReadout: showReadout, hideReadout: hideReadout, number: number, isValue: isValue,
    section: section, legend: legend, valueExtent: valueExtent, decades: decades
  };
})();
