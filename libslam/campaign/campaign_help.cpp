#include <string_view>

#include <libslam/campaign/campaign_help.hpp>
#include <libslam/campaign/campaign_plan.hpp>
#include <libslam/config/help.hpp>

namespace libslam {

namespace {

constexpr std::string_view kIntroduction =
    R"(# Campaigns and scenarios

<!-- Generated: slam-campaign --help-config markdown > config/CAMPAIGNS.md -->

A scenario is a world, a vehicle, its sensors and what is wrong with them; `slam-simulate` drives one,
`slam-campaign` many of them, and lets every filter see the same logs:

```yaml
campaign: {runs: 50, batches: 6, seed: 1, reference: standard}
scenario: sim_webmap.yaml                # a file beside this one, or its sections
filter: {measurement: {sigma_range: 0.3}}   # for all variants: a file or the sections of a run
variants:                                # name -> changes of the filter
  standard: {filter: {error_frame: standard}}
  calibrated:
    calibration: {scale_left: {enabled: true}, scale_right: {enabled: true}}
  mrpt: {engine: mrpt}                   # MRPT's CRangeBearingKFSLAM2D; mrpt_davison: by its other method
grid:                                    # every combination is a point
  scenario.truth.scale_left, scenario.truth.scale_right: [1, 1.05]   # joined: change together
  filter.measurement.sigma_range: [0.2, 0.4]
```

- The filter knows the nominal vehicle of the scenario (its section `motion`), its odometry field and the
  nominal noise of its range-bearing sensor, unless `filter`, the grid or a variant (in this order) says
  otherwise. Keys of a filter are those of a run: [README.md](README.md).
- `--set campaign.KEY=V`, `--set scenario.KEY=V` and `--set filter.KEY=V` act before grid and variants.
- In a scenario file the keys below stand without `scenario.`; its `seed` is that of `slam-simulate`, a
  campaign has its own.
- `slam-campaign --print-config` shows every effective scenario and filter and runs nothing.

SI units and radians; degrees only in keys that end in `_deg`.
)";

struct CampaignKeys {
  CampaignParameters campaign;
  Scenario scenario;

  void describe(auto& v) {
    v.section("campaign", campaign);
    v.section("scenario", scenario);
  }
};

}  // namespace

std::string campaign_help_text() {
  CampaignKeys keys;
  return help_text(ParameterTable(keys));
}

std::string campaign_help_markdown() {
  CampaignKeys keys;
  return std::string(kIntroduction) + help_tables(ParameterTable(keys));
}

}  // namespace libslam
