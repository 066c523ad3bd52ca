#include <algorithm>
#include <cctype>
#include <set>

#include <libslam/campaign/campaign_draft.hpp>
#include <libslam/config/text_file.hpp>
#include <libslam/config/yaml_loader.hpp>

namespace libslam {

namespace {

constexpr std::size_t kMostVariants = 100;

[[noreturn]] void fail(const std::filesystem::path& file, FilePlace place,
                       const std::string& message) {
  throw ConfigError(describe_place(file.string(), place) + ": " + message);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

GridAxis read_axis(const std::filesystem::path& file, const YamlEntry& entry) {
  GridAxis axis;
  std::string_view rest = entry.key;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = rest.find(',');
    const std::string_view key = trimmed(rest.substr(0, comma));
    if (target_of(key).empty())
      fail(file, entry.place,
           "grid: " + quote_for_message(key) + " must begin with scenario. or filter.");
    if (key == "scenario.seed")
      fail(file, entry.place, "grid: scenario.seed has no effect; campaign.seed numbers the runs");
    axis.keys.emplace_back(key);
    if (comma != std::string_view::npos) rest = rest.substr(comma + 1);
  }
  if (entry.value.kind != YamlNode::Kind::kSequence || entry.value.items.empty())
    fail(file, entry.value.place, "grid: a list of values is expected, [1, 2]");
  for (const YamlNode& item : entry.value.items) {
    if (item.kind != YamlNode::Kind::kScalar || item.is_null())
      fail(file, item.place, "grid: a plain value is expected");
    axis.values.push_back(item.text);
  }
  return axis;
}

const YamlNode& expect_mapping(const std::filesystem::path& file, const YamlNode& node,
                               const char* what) {
  if (node.kind != YamlNode::Kind::kMapping)
    fail(file, node.place, std::string(what) + ": indented `key: value` lines are expected");
  return node;
}

const YamlNode& expect_source(const std::filesystem::path& file, const YamlNode& node) {
  if (node.kind == YamlNode::Kind::kSequence)
    fail(file, node.place, "a file name or a mapping is expected");
  return node;
}

void require_name(const std::filesystem::path& file, const YamlEntry& variant) {
  const bool plain = !variant.key.empty() && variant.key.size() <= 40 &&
                     std::ranges::all_of(variant.key, [](unsigned char c) {
                       return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
                     });
  if (!plain)
    fail(file, variant.place,
         "a variant is named by up to 40 letters, digits, '_', '-' and '.', not " +
             quote_for_message(variant.key));
}

VariantDraft read_variant(const std::filesystem::path& file, const YamlEntry& entry) {
  require_name(file, entry);
  VariantDraft variant{entry.key, Engine::kLibslam, {}};
  if (entry.value.is_null()) return variant;
  variant.changes = expect_mapping(file, entry.value, "a variant");
  std::erase_if(variant.changes.entries, [&](const YamlEntry& change) {
    if (change.key != "engine") return false;
    const std::string& name = change.value.text;
    if (name != "libslam" && name != "mrpt" && name != "mrpt_davison")
      fail(file, change.value.place, "engine: one of libslam, mrpt, mrpt_davison");
    if (name != "libslam") variant.engine = name == "mrpt" ? Engine::kMrpt : Engine::kMrptDavison;
    return true;
  });
  return variant;
}

/// The later one of two axes would silently win.
void refuse_repeated_keys(const std::filesystem::path& file, const YamlNode& grid,
                          const std::vector<GridAxis>& axes) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const std::string& key : axes[i].keys)
      if (!seen.insert(key).second)
        fail(file, grid.entries[i].place, "grid: " + quote_for_message(key) + " is given twice");
}

CampaignDraft read_file(const std::filesystem::path& file, CampaignParameters& campaign) {
  const YamlNode root = parse_yaml(read_config_text(file), file.string());
  CampaignDraft draft;
  draft.file = file;
  for (const YamlEntry& entry : root.entries) {
    if (entry.key == "campaign") {
      load_yaml(ParameterTable(campaign), expect_mapping(file, entry.value, "campaign"),
                file.string());
    } else if (entry.key == "scenario") {
      draft.scenario = expect_source(file, entry.value);
    } else if (entry.key == "filter") {
      draft.filter = expect_source(file, entry.value);
    } else if (entry.key == "variants") {
      for (const YamlEntry& variant : expect_mapping(file, entry.value, "variants").entries)
        draft.variants.push_back(read_variant(file, variant));
    } else if (entry.key == "grid") {
      for (const YamlEntry& axis : expect_mapping(file, entry.value, "grid").entries)
        draft.grid.push_back(read_axis(file, axis));
      refuse_repeated_keys(file, entry.value, draft.grid);
    } else {
      fail(file, entry.place,
           "unknown section " + quote_for_message(entry.key) +
               "; valid are campaign, scenario, filter, variants and grid");
    }
  }
  if (draft.variants.empty()) draft.variants.push_back({"filter", Engine::kLibslam, {}});
  if (draft.variants.size() > kMostVariants)
    throw ConfigError(file.string() + ": more than " + std::to_string(kMostVariants) + " variants");
  return draft;
}

/// Sorts command-line settings by what they address; those of the campaign are applied.
void sort_settings(const std::vector<std::string>& settings, CampaignParameters& campaign,
                   CampaignDraft& draft) {
  for (const std::string& setting : settings) {
    if (setting.starts_with("campaign."))
      set_parameter(ParameterTable(campaign), setting.substr(9));
    else if (setting.starts_with("scenario.seed="))
      throw ConfigError("--set " + quote_for_message(setting) +
                        ": has no effect; campaign.seed numbers the runs");
    else if (setting.starts_with("scenario."))
      draft.scenario_settings.push_back(setting.substr(9));
    else if (setting.starts_with("filter."))
      draft.filter_settings.push_back(setting.substr(7));
    else
      throw ConfigError("--set " + quote_for_message(setting) +
                        ": must begin with campaign., scenario. or filter.");
  }
}

}  // namespace

std::string_view target_of(std::string_view key) {
  for (const std::string_view target : {"scenario.", "filter."})
    if (key.starts_with(target) && key.size() > target.size()) return target;
  return {};
}

CampaignDraft read_campaign_draft(const std::filesystem::path& file,
                                  const std::vector<std::string>& settings,
                                  CampaignParameters& campaign) {
  CampaignDraft draft = read_file(file, campaign);
  sort_settings(settings, campaign, draft);
  return draft;
}

}  // namespace libslam
