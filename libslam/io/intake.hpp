#pragma once
// What was read from a log, and what is done with entries that are not as they should be.

#include <cstdint>
#include <string>
#include <vector>

namespace libslam {

/// The `input` part of a run's summary.
struct InputSummary {
  std::int64_t entries = 0;           ///< objects read from the file
  std::int64_t actions = 0;           ///< steps with a motion
  std::int64_t observations = 0;      ///< observations other than odometry that reached a step
  double duration_s = 0.0;            ///< from the first to the last step [s]
  std::int64_t skipped = 0;           ///< entries, or parts of an entry, that were left out
  std::int64_t repaired = 0;          ///< entries that were used after mending
  bool leading_frame = false;         ///< observations came before the first motion
  bool damaged = false;               ///< the file could not be read to its end
  std::vector<std::string> warnings;  ///< the first ones, each naming its entry
  std::int64_t warnings_omitted = 0;  ///< warnings beyond those kept

  /// Part of the input was unusable: a program that otherwise succeeded exits with 5.
  bool incomplete() const { return damaged || skipped > 0; }
};

enum class IntakePolicy { kStrict, kSkip, kRepair };

/// Applies one policy to every defect of a log and keeps the summary.
class Intake {
 public:
  /// `policy`: "strict", "skip" or "repair". Throws std::invalid_argument otherwise.
  Intake(std::string file, const std::string& policy);

  /// Something that cannot be used. strict: throws InputError; else counted as skipped.
  void skip(std::int64_t entry, const std::string& what);

  /// Something that can be mended at a price. strict: throws InputError; skip: counted as skipped,
  /// returns false; repair: counted as repaired, returns true.
  bool may_repair(std::int64_t entry, const std::string& what);

  /// Something that can be mended without loss, such as a wrong time in a log whose order carries
  /// the motion. strict: throws InputError; else counted as repaired.
  void mend(std::int64_t entry, const std::string& what);

  /// Something missing that old logs never had. Counted as repaired under every policy; one warning
  /// for each text.
  void fill_in(std::int64_t entry, const std::string& what);

  /// Worth knowing, nothing was changed. One warning for each text.
  void note(std::int64_t entry, const std::string& what);

  /// The rest of the file cannot be read. strict: throws InputError; else kept as a warning.
  void end_early(const std::string& damage);

  InputSummary& summary() { return summary_; }
  const InputSummary& summary() const { return summary_; }

 private:
  std::string place(std::int64_t entry, const std::string& what) const;
  void warn(const std::string& text);

  std::string file_;
  IntakePolicy policy_;
  InputSummary summary_;
  std::vector<std::string> noted_;
};

}  // namespace libslam
