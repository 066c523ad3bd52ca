#pragma once
// When a frame may update the filter. Between updates odometry goes on.

namespace libslam {

/// Sensor errors of real logs are correlated in time; a filter that takes every frame as fresh
/// information becomes overconfident. Both conditions must hold.
class UpdateSchedule {
 public:
  /// `period`: shortest time between updates [s], 0: none; `every_n`: use every n-th frame.
  /// Throws std::invalid_argument if period < 0 or every_n < 1.
  UpdateSchedule(double period, int every_n);

  /// True if a frame with features at `time` [s] is due; counts the frame.
  bool due(double time);

 private:
  double period_;
  int every_n_;
  double next_ = 0.0;
  bool started_ = false;
  long frames_ = 0;
};

}  // namespace libslam
