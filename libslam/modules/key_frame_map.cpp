#include <mrpt/maps/CBeaconMap.h>
#include <mrpt/poses/Lie/SO.h>

#include <libslam/modules/key_frame_map.hpp>
#include <libslam/modules/simple_map_carrier.hpp>

namespace libslam {

namespace {

mrpt::maps::CBeacon make_beacon(const LandmarkEstimate& landmark) {
  mrpt::maps::CBeacon beacon;
  beacon.m_ID = landmark.id;
  beacon.m_typePDF = mrpt::maps::CBeacon::pdfGauss;
  const Eigen::Index size = landmark.mean.size();
  beacon.m_locationGauss.mean =
      mrpt::poses::CPoint3D(landmark.mean[0], landmark.mean[1], size > 2 ? landmark.mean[2] : 0.0);
  beacon.m_locationGauss.cov.setZero();
  for (int r = 0; r < static_cast<int>(size); ++r)
    for (int c = 0; c < static_cast<int>(size); ++c)
      beacon.m_locationGauss.cov(r, c) = landmark.cov(r, c);
  return beacon;
}

}  // namespace

KeyFrameMap::KeyFrameMap(const mrpt::maps::TSetOfMetricMapInitializers& metric_maps)
    : metric_map_(metric_maps), landmarks_(mrpt::maps::CBeaconMap::Create()) {
  landmarks_->genericMapParams.enableObservationInsertion = false;  // they are the filter's alone
  metric_map_.maps.push_back(landmarks_);
}

void KeyFrameMap::insert(const mrpt::maps::CSimpleMap& earlier) {
  for (const auto& [pose, frame] : earlier) {
    mrpt::poses::CPose3DPDFGaussian gaussian;
    gaussian.copyFrom(*pose);
    insert(gaussian, without_map(frame));
  }
}

bool KeyFrameMap::is_due(const mrpt::poses::CPose3D& T_world_robot, const Spacing& spacing) const {
  if (!last_) return true;
  const mrpt::poses::CPose3D moved = T_world_robot - *last_;
  return moved.norm() >= spacing.distance ||
         mrpt::poses::Lie::SO<3>::log(moved.getRotationMatrix()).norm() >= spacing.angle;
}

void KeyFrameMap::insert(const mrpt::poses::CPose3DPDFGaussian& T_world_robot,
                         const mrpt::obs::CSensoryFrame::Ptr& frame) {
  last_ = T_world_robot.mean;
  key_frames_.insert(mrpt::poses::CPose3DPDFGaussian::Create(T_world_robot), frame);
  frame->insertObservationsInto(metric_map_, T_world_robot.mean);
}

void KeyFrameMap::show(const std::vector<LandmarkEstimate>& landmarks) {
  landmarks_->clear();
  for (const LandmarkEstimate& landmark : landmarks)
    if (landmark.type == "point") landmarks_->push_back(make_beacon(landmark));
}

}  // namespace libslam
