#include <algorithm>
#include <stdexcept>

#include <libslam/io/input_error.hpp>
#include <libslam/io/intake.hpp>

namespace libslam {
namespace {

/// A log with a defect in every entry must not fill the memory with warnings.
constexpr std::size_t kMaxWarnings = 20;

IntakePolicy parse_policy(const std::string& name) {
  if (name == "strict") return IntakePolicy::kStrict;
  if (name == "skip") return IntakePolicy::kSkip;
  if (name == "repair") return IntakePolicy::kRepair;
  throw std::invalid_argument("input policy must be strict, skip or repair, not '" + name + "'");
}

}  // namespace

Intake::Intake(std::string file, const std::string& policy)
    : file_(std::move(file)), policy_(parse_policy(policy)) {}

void Intake::skip(std::int64_t entry, const std::string& what) {
  if (policy_ == IntakePolicy::kStrict) throw InputError(place(entry, what));
  ++summary_.skipped;
  warn(place(entry, what + ": left out"));
}

bool Intake::may_repair(std::int64_t entry, const std::string& what) {
  if (policy_ == IntakePolicy::kRepair) {
    mend(entry, what);
    return true;
  }
  skip(entry, what);
  return false;
}

void Intake::mend(std::int64_t entry, const std::string& what) {
  if (policy_ == IntakePolicy::kStrict) throw InputError(place(entry, what));
  ++summary_.repaired;
  warn(place(entry, what + ": repaired"));
}

void Intake::fill_in(std::int64_t entry, const std::string& what) {
  ++summary_.repaired;
  note(entry, what + ": repaired");
}

void Intake::note(std::int64_t entry, const std::string& what) {
  if (std::find(noted_.begin(), noted_.end(), what) != noted_.end()) return;
  noted_.push_back(what);
  warn(place(entry, what));
}

void Intake::end_early(const std::string& damage) {
  if (policy_ == IntakePolicy::kStrict) throw InputError(damage);
  summary_.damaged = true;
  // The reason why a run is incomplete is kept even when lesser warnings have filled the list.
  summary_.warnings.push_back(damage + ": the log ends here");
}

std::string Intake::place(std::int64_t entry, const std::string& what) const {
  return file_ + ": entry " + std::to_string(entry) + ": " + what;
}

void Intake::warn(const std::string& text) {
  if (summary_.warnings.size() < kMaxWarnings)
    summary_.warnings.push_back(text);
  else
    ++summary_.warnings_omitted;
}

}  // namespace libslam
