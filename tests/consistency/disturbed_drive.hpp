#pragma once
// One simulated drive with slips or a kidnap, one filter, and how long it took to find back.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <libslam/data/step_events.hpp>
#include <libslam/pipeline/pipeline.hpp>
#include <libslam/pipeline/simulation.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam::test {

struct DisturbedDrive {
  std::vector<int> recoveries;        ///< updates until recovered, by event; -1: never
  std::map<std::string, int> events;  ///< of the filter, by name
  double landmark_rmse = 0.0;         ///< known identities, in the frame of the filter [m]
  double position_rmse = 0.0;         ///< over all updates [m]
  double last_error = 0.0;            ///< of the position at the end [m]
  int relocalized_after = -1;         ///< updates after the first event
  bool wrong_recovery = false;        ///< relocalized, and still far off
  /// Updates after the first event until the robot is back (two pairs, less than kWrongRecovery
  /// off), or all, in which at least four landmarks of the map of then are in range.
  int views = 0;
  bool back = false;
};

/// Recovered: the position error is below twice what it was on average in so many updates before.
constexpr std::size_t kLevelUpdates = 25;
/// A relocalization that leaves a larger position error is a wrong one [m].
constexpr double kWrongRecovery = 5.0;

class DisturbedDriver {
 public:
  DisturbedDriver(const Scenario& scenario, const Parameters& parameters, std::uint64_t seed)
      : scenario_(scenario),
        simulator_(make_simulator(scenario, seed)),
        pipeline_(parameters),
        known_(parameters.association.uses_identities()) {}

  DisturbedDrive drive() {
    while (const auto step = simulator_->next()) {
      const Eigen::Vector3d truth = relative_pose(simulator_->start(), step->T_world_robot);
      notice_event(*step, truth);
      const StepRecord record = pipeline_.process(step->step);
      if (step->step.frame) judge(record, truth);
    }
    drive_.recoveries.insert(drive_.recoveries.end(), open_.size(), -1);
    drive_.position_rmse = std::sqrt(squares_ / std::max(1.0, static_cast<double>(errors_.size())));
    drive_.last_error = errors_.back();
    drive_.landmark_rmse = landmark_rmse();
    return drive_;
  }

 private:
  struct Event {
    double level;
    int updates = 0;
  };

  /// Slips and kidnaps move the robot by what its odometry does not say.
  void notice_event(const SimulatedStep& step, const Eigen::Vector3d& truth) {
    bool moved = false;
    if (before_ && scenario_.faults.kidnap.enabled) {
      const double time = step.step.time - start_time_;
      moved = time_ < scenario_.faults.kidnap.time_s && time >= scenario_.faults.kidnap.time_s;
    }
    if (!before_) start_time_ = step.step.time;
    if (before_ && scenario_.faults.slip.enabled) {
      const double travel = (truth - *before_).head<2>().norm();
      const double nominal = scenario_.drive.speed * scenario_.drive.control_period_s;
      const bool slips = travel < 0.5 * (1.0 + scenario_.faults.slip.travel_factor) * nominal;
      moved = slips && !slipping_;
      slipping_ = slips;
    }
    time_ = step.step.time - start_time_;
    before_ = truth;
    if (!moved || errors_.size() < kLevelUpdates) return;
    double sum = 0.0;
    for (std::size_t i = errors_.size() - kLevelUpdates; i < errors_.size(); ++i) sum += errors_[i];
    open_.push_back({2.0 * sum / kLevelUpdates});
    if (!happened_) remember_map();
    happened_ = true;
  }

  void judge(const StepRecord& record, const Eigen::Vector3d& truth) {
    const double error = (record.pose - truth).head<2>().norm();
    errors_.push_back(error);
    squares_ += error * error;
    for_each_event(record.event,
                   [&](std::string_view name) { ++drive_.events[std::string(name)]; });
    if (happened_) ++since_event_;
    if (happened_ && !drive_.back) {
      if (mapped_in_range(truth) >= 4) ++drive_.views;
      drive_.back = error < kWrongRecovery && record.accepted >= 2;
    }
    if (has_event(record.event, "relocalized")) {
      drive_.wrong_recovery = drive_.wrong_recovery || error > kWrongRecovery;
      if (drive_.relocalized_after < 0) drive_.relocalized_after = since_event_;
    }
    for (Event& event : open_) ++event.updates;
    std::erase_if(open_, [&](const Event& event) {
      if (error >= event.level) return false;
      drive_.recoveries.push_back(event.updates);
      return true;
    });
  }

  /// Landmarks of the world that the filter has a landmark near to.
  void remember_map() {
    const auto map = pipeline_.filter().landmarks();
    for (const TrueLandmark& landmark : simulator_->landmarks()) {
      const Eigen::Vector2d place =
          transform_back(simulator_->start(), Eigen::Vector2d(landmark.position.head<2>()));
      const auto near = [&](const LandmarkEstimate& one) {
        return (one.mean.head<2>() - place).norm() < kWrongRecovery;
      };
      if (std::ranges::any_of(map, near)) mapped_.push_back(place);
    }
  }
  std::ptrdiff_t mapped_in_range(const Eigen::Vector3d& truth) const {
    return std::ranges::count_if(mapped_, [&](const Eigen::Vector2d& place) {
      return (place - truth.head<2>()).norm() < scenario_.range_bearing.max_range;
    });
  }

  double landmark_rmse() const {
    if (!known_) return 0.0;
    double sum = 0.0;
    const auto map = pipeline_.filter().landmarks();
    for (const LandmarkEstimate& landmark : map)
      for (const TrueLandmark& truth : simulator_->landmarks())
        if (truth.id == landmark.id)
          sum += (landmark.mean -
                  transform_back(simulator_->start(), Eigen::Vector2d(truth.position.head<2>())))
                     .squaredNorm();
    return std::sqrt(sum / std::max(1.0, static_cast<double>(map.size())));
  }

  Scenario scenario_;
  std::unique_ptr<Simulator> simulator_;
  Pipeline pipeline_;
  bool known_;
  std::optional<Eigen::Vector3d> before_;
  double start_time_ = 0.0, time_ = 0.0;
  bool slipping_ = false, happened_ = false;
  std::vector<Event> open_;
  std::vector<Eigen::Vector2d> mapped_;
  std::vector<double> errors_;
  double squares_ = 0.0;
  int since_event_ = 0;
  DisturbedDrive drive_;
};

}  // namespace libslam::test
