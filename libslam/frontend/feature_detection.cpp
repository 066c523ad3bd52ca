#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <libslam/frontend/feature_detection.hpp>

namespace libslam {

namespace {

constexpr double kOrbScale = 1.2;
constexpr int kOrbLevels = 8;
/// Candidates per point kept: spreading needs a choice.
constexpr int kCandidates = 3;
/// Points per cell of the grid when the budget is met evenly.
constexpr double kPointsPerCell = 4.0;

auto order_of(const cv::KeyPoint& p) {
  return std::make_tuple(-p.response, p.pt.y, p.pt.x, p.size, p.angle);
}

/// Row `row` of OpenCV's descriptors: bytes, or the floats of SIFT.
std::shared_ptr<const Descriptor> to_descriptor(const cv::Mat& descriptors, int row) {
  auto out = std::make_shared<Descriptor>();
  const bool bits = descriptors.depth() == CV_8U;
  out->kind = bits ? Descriptor::Kind::kBits : Descriptor::Kind::kNumbers;
  const int size = std::min(descriptors.cols, static_cast<int>(out->bytes.size()));
  out->size = static_cast<std::uint8_t>(size);
  for (int i = 0; i < size; ++i)
    out->bytes[static_cast<std::size_t>(i)] =
        bits ? descriptors.at<std::uint8_t>(row, i)
             : static_cast<std::uint8_t>(
                   std::clamp(std::lround(descriptors.at<float>(row, i)), 0L, 255L));
  return out;
}

}  // namespace

void spread(std::vector<cv::KeyPoint>& points, cv::Size size, int budget) {
  std::sort(points.begin(), points.end(),
            [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return order_of(a) < order_of(b); });
  const double side =
      std::max(8.0, std::sqrt(static_cast<double>(size.area()) * kPointsPerCell / budget));
  const int columns = static_cast<int>(size.width / side) + 1;
  const int rows = static_cast<int>(size.height / side) + 1;
  std::vector<int> taken(static_cast<std::size_t>(columns * rows), 0);
  std::vector<std::pair<int, std::size_t>> turns;  // of a cell, then by strength
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int column = std::clamp(static_cast<int>(points[i].pt.x / side), 0, columns - 1);
    const int row = std::clamp(static_cast<int>(points[i].pt.y / side), 0, rows - 1);
    turns.emplace_back(taken[static_cast<std::size_t>(row * columns + column)]++, i);
  }
  std::sort(turns.begin(), turns.end());
  turns.resize(std::min(turns.size(), static_cast<std::size_t>(budget)));
  std::vector<cv::KeyPoint> kept;
  kept.reserve(turns.size());
  for (const auto& [turn, i] : turns) kept.push_back(points[i]);
  points = std::move(kept);
}

FeatureDetector::FeatureDetector(const std::string& name, int budget) : budget_(budget) {
  if (name == "orb") {
    detector_ = cv::ORB::create(kCandidates * budget, static_cast<float>(kOrbScale), kOrbLevels, 19,
                                0, 2, cv::ORB::HARRIS_SCORE, 31, 7);
    octave_scale_ = kOrbScale;
    finest_size_ = 31.0;
  } else if (name == "akaze") {
    detector_ = cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, 2e-4F);
    octave_scale_ = 2.0;
    finest_size_ = 4.8;
  } else if (name == "sift") {
    detector_ = cv::SIFT::create(kCandidates * budget, 3, 0.02, 10.0, 1.6);
    octave_scale_ = 0.0;
    finest_size_ = 4.0;
  } else {
    throw std::invalid_argument("unknown feature detector '" + name + "'");
  }
}

DetectedPoints FeatureDetector::detect(const cv::Mat& image) const {
  DetectedPoints found;
  detector_->detect(image, found.points);
  spread(found.points, image.size(), budget_);
  cv::Mat descriptors;
  detector_->compute(image, found.points, descriptors);
  for (int row = 0; row < descriptors.rows; ++row)
    found.descriptors.push_back(to_descriptor(descriptors, row));
  return found;
}

double FeatureDetector::scale_of(const cv::KeyPoint& point) const {
  if (octave_scale_ > 0.0) return std::pow(octave_scale_, point.octave);
  return std::max(1.0, static_cast<double>(point.size) / finest_size_);
}

std::vector<std::shared_ptr<const Descriptor>> describe_corners(
    const cv::Mat& image, const std::vector<cv::Point2f>& corners) {
  const auto orb = cv::ORB::create(static_cast<int>(corners.size()) + 1, 1.2F, 1, 1);
  std::vector<cv::KeyPoint> points;
  for (std::size_t i = 0; i < corners.size(); ++i)
    points.emplace_back(corners[i], 31.0F, 0.0F, 0.0F, 0, static_cast<int>(i));
  cv::Mat descriptors;
  orb->compute(image, points, descriptors);
  std::vector<std::shared_ptr<const Descriptor>> described(corners.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    described[static_cast<std::size_t>(points[i].class_id)] =
        to_descriptor(descriptors, static_cast<int>(i));
  return described;
}

}  // namespace libslam
