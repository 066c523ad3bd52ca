#pragma once
// Figures of a campaign.json by their place.

#include <initializer_list>
#include <limits>

#include <nlohmann/json.hpp>

namespace libslam {

/// The value at a path of keys; null where one of them is missing.
inline const nlohmann::ordered_json* value_at(const nlohmann::ordered_json& object,
                                              std::initializer_list<const char*> keys) {
  const nlohmann::ordered_json* at = &object;
  for (const char* key : keys) {
    if (!at->is_object()) return nullptr;
    const auto found = at->find(key);
    if (found == at->end()) return nullptr;
    at = &*found;
  }
  return at;
}

/// The number at a path of keys; NaN where there is none.
inline double figure_at(const nlohmann::ordered_json& object,
                        std::initializer_list<const char*> keys) {
  const nlohmann::ordered_json* value = value_at(object, keys);
  return value != nullptr && value->is_number() ? value->get<double>()
                                                : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace libslam
