#include <cmath>
#include <limits>

#include <libslam/campaign/run_outcome.hpp>

namespace libslam {

namespace {

using Json = nlohmann::ordered_json;

Json series_to_json(const ErrorSeries& series) {
  return {{"times", series.times}, {"errors", series.errors}, {"sigmas", series.sigmas}};
}

ErrorSeries series_from_json(const Json& in) {
  ErrorSeries series;
  in.at("times").get_to(series.times);
  in.at("errors").get_to(series.errors);
  in.at("sigmas").get_to(series.sigmas);
  return series;
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const RunOutcome& outcome) {
  Json out = {{"retried", outcome.retried}, {"variants", Json::array()}};
  for (const VariantOutcome& v : outcome.variants)
    out["variants"].push_back({{"status", v.status},
                               {"figures", v.figures},
                               {"sums", {v.sums.x, v.sums.y, v.sums.heading, v.sums.count}},
                               {"nees", v.nees},
                               {"series", series_to_json(v.series)}});
  return Json::to_cbor(out);
}

RunOutcome outcome_from_bytes(const std::vector<std::uint8_t>& bytes) {
  const Json in = Json::from_cbor(bytes);
  RunOutcome outcome;
  in.at("retried").get_to(outcome.retried);
  for (const Json& v : in.at("variants")) {
    VariantOutcome& variant = outcome.variants.emplace_back();
    v.at("status").get_to(variant.status);
    variant.figures = v.at("figures");
    const Json& sums = v.at("sums");
    variant.sums = {sums.at(0), sums.at(1), sums.at(2), sums.at(3)};
    v.at("nees").get_to(variant.nees);
    variant.series = series_from_json(v.at("series"));
  }
  return outcome;
}

}  // namespace libslam
