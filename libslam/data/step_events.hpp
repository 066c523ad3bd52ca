#pragma once
// What happened in one step, in one word of the log: names joined by '+' in the order in which they
// happened, each once. "disturbance+relocalized".

#include <string>
#include <string_view>

namespace libslam {

/// Calls visit(name) for each name in `events`.
template <class Visit>
void for_each_event(std::string_view events, Visit visit) {
  while (!events.empty()) {
    const std::size_t end = events.find('+');
    visit(events.substr(0, end));
    if (end == std::string_view::npos) return;
    events.remove_prefix(end + 1);
  }
}

inline bool has_event(std::string_view events, std::string_view name) {
  bool found = false;
  for_each_event(events, [&](std::string_view one) { found = found || one == name; });
  return found;
}

/// Appends the names in `more` that are not there yet.
inline void add_events(std::string& events, std::string_view more) {
  for_each_event(more, [&](std::string_view one) {
    if (has_event(events, one)) return;
    if (!events.empty()) events += '+';
    events += one;
  });
}

}  // namespace libslam
