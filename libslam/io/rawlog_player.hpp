#pragma once
// The one source of log steps: a rawlog of either flavour, streamed with bounded memory.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <libslam/config/parameters.hpp>
#include <libslam/data/log_step.hpp>
#include <libslam/io/intake.hpp>
#include <libslam/io/observation_splitter.hpp>
#include <libslam/io/pair_assembler.hpp>
#include <libslam/io/playback_pace.hpp>
#include <libslam/io/rawlog_guard.hpp>

namespace libslam {

struct PlayerOptions {
  InputParameters input;  ///< policy and label filters
  GuardLimits limits;
  Pacing pacing;
  /// Sees every entry as it is read, before any filter; must not change it.
  std::function<void(const RawlogEntry&)> on_entry;
};

/// Plays a rawlog as steps (libslam/data/log_step.hpp).
///
/// Given   (action, frame) pairs, one step for each pair (PairAssembler);
/// given   observations one after another, or frames without actions, with absolute odometry among
///         them, one step for each odometry reading and each observation time
///         (ObservationSplitter); with `input.odometry` twist the velocities of CObservationIMU
///         take the place of odometry, and each holds until the next.
/// The flavour is decided by whether an action is among the first entries; entries of the other
/// flavour are left out with a warning, since using both would count the motion twice.
///
/// Defects are handled as `input.policy` says: strict throws InputError at the first one; skip
/// leaves out what cannot be used; repair also uses what can be mended. In observation-only logs,
/// whose times carry the motion, an entry that goes back in time is left out (skip) or moved to the
/// present (repair). A file whose rest is unreadable ends there, with a warning
/// (`summary().damaged`); strict throws. Externally stored images are found beside the log as
/// MRPT's own programs find them; the directory is a global of MRPT (CImage), so two logs with
/// external images cannot be played at once.
class RawlogPlayer {
 public:
  /// Throws InputError if `file` is not a rawlog, std::invalid_argument on an unknown policy.
  explicit RawlogPlayer(const std::string& file, const PlayerOptions& options = {});
  ~RawlogPlayer();

  /// The next step, in its time if the pacing says so; nothing at the end or when the pacing stops.
  /// Throws InputError (see above).
  std::optional<LogStep> next();

  /// Part of the file that was read, in [0, 1].
  double progress() const { return guard_.progress(); }
  /// What was read so far.
  const InputSummary& summary() const { return intake_.summary(); }
  /// Actions drive the motion; else absolute odometry does.
  bool is_pair_log() const { return is_pair_log_; }

 private:
  bool read_entry();
  void decide_flavour();
  std::optional<RawlogEntry> fetch();
  void dispatch(const RawlogEntry& entry);
  void add_observation(const mrpt::obs::CObservation::Ptr& observation, const RawlogEntry& entry,
                       std::uint64_t bytes);
  void add_odometry(mrpt::obs::CObservationOdometry& odometry, const RawlogEntry& entry);
  void add_velocity(const mrpt::obs::CObservationIMU& imu, const RawlogEntry& entry);
  /// Gives a reading its time and its place in the log.
  void place_reading(OdometryReading reading, std::optional<double> stamp,
                     const RawlogEntry& entry);
  /// The velocities of this observation drive the log.
  bool is_velocity(const mrpt::obs::CObservation& observation) const;
  void add_frame(const RawlogEntry& entry);
  bool is_sensor_path(const mrpt::obs::CObservation& observation) const;
  bool wanted(const mrpt::obs::CObservation& observation) const;
  std::deque<LogStep>& ready() { return is_pair_log_ ? pairs_.ready() : splitter_.ready(); }
  void account(LogStep& step);

  PlayerOptions options_;
  Intake intake_;
  RawlogGuard guard_;
  PairAssembler pairs_;
  ObservationSplitter splitter_;
  PlaybackPace pace_;
  std::deque<RawlogEntry> ahead_;  ///< read while the flavour was decided
  bool is_pair_log_ = false;
  bool finished_ = false;
  bool any_motion_ = false;
  std::int64_t index_ = 0;
  double first_time_ = 0.0;
};

}  // namespace libslam
