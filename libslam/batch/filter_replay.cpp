#include <stdexcept>

#include <libslam/batch/batch_recorder.hpp>
#include <libslam/batch/filter_replay.hpp>
#include <libslam/io/rawlog_player.hpp>
#include <libslam/pipeline/factory.hpp>
#include <libslam/pipeline/pipeline.hpp>

namespace libslam {

FilterReplay replay_filter(const std::string& rawlog, const Parameters& parameters,
                           std::int64_t max_steps) {
  PlayerOptions options;
  options.input = parameters.input;
  RawlogPlayer player(rawlog, options);
  if (!parameters.map.file.empty())
    throw std::invalid_argument("a batch starts without a map, the run started in " +
                                parameters.map.file);
  const EkfSlamParts parts = make_filter_parts(parameters);
  if (parts.motion->pose_spec().chart != Chart::kSE2)
    throw std::invalid_argument("a batch is planar; motion.model " + parameters.motion.model +
                                " moves in space");
  if (!parts.measurement)
    throw std::invalid_argument("a batch needs landmarks; measurement.model " +
                                parameters.measurement.model + " has none");
  Pipeline pipeline(parameters);
  BatchRecorder recorder(pipeline.filter());
  pipeline.observe(&recorder);

  FilterReplay replay;
  for (std::int64_t count = 0; count < max_steps; ++count) {
    const auto step = player.next();
    if (!step) break;
    StepRecord record;
    try {
      record = pipeline.process(*step);
    } catch (const UnusableOdometry&) {
      record = pipeline.process_frame(*step);
    }
    recorder.end_step(record.index, record.time);
    replay.path.push_back({record.index, record.time, record.pose, record.cov});
  }
  replay.log = recorder.log();
  replay.estimate = recorder.estimate();
  replay.map = LandmarkMap(pipeline.filter().landmarks());
  replay.calibration = pipeline.filter().calibration();
  return replay;
}

}  // namespace libslam
