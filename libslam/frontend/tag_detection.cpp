#include <algorithm>
#include <apriltag/apriltag.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagStandard41h12.h>
#include <stdexcept>
#include <utility>

#include <opencv2/aruco.hpp>

#include <libslam/frontend/tag_detection.hpp>

namespace libslam {

namespace {

/// Contrast between the bits of a tag and the decision threshold; AprilTag's authors see false
/// detections below this.
constexpr float kLeastMargin = 30.0F;

struct Family {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

constexpr Family kFamilies[] = {
    {"tag36h11", tag36h11_create, tag36h11_destroy},
    {"tag25h9", tag25h9_create, tag25h9_destroy},
    {"tag16h5", tag16h5_create, tag16h5_destroy},
    {"tagStandard41h12", tagStandard41h12_create, tagStandard41h12_destroy}};

constexpr std::pair<const char*, cv::aruco::PREDEFINED_DICTIONARY_NAME> kDictionaries[] = {
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL}};

class AprilTagDetector final : public TagDetector {
 public:
  AprilTagDetector(const Family& family, double decimate)
      : family_(family.create(), family.destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    detector_->nthreads = 1;  // the order of what is found does not depend on threads
    detector_->quad_decimate = static_cast<float>(decimate);
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), 1);
  }

 private:
  std::vector<DetectedTag> find(const cv::Mat& gray) const override {
    cv::Mat pixels = gray.isContinuous() ? gray : gray.clone();
    image_u8_t image{pixels.cols, pixels.rows, pixels.cols, pixels.data};
    zarray_t* found = apriltag_detector_detect(detector_.get(), &image);
    std::vector<DetectedTag> tags;
    for (int i = 0; i < zarray_size(found); ++i) {
      const apriltag_detection_t* detection = nullptr;
      zarray_get(found, i, &detection);
      if (detection->decision_margin < kLeastMargin) continue;
      DetectedTag& tag = tags.emplace_back();
      tag.id = detection->id;
      // AprilTag goes round from the bottom left against the clock, and its pixel 0 lies at 0.5.
      for (std::size_t k = 0; k < 4; ++k)
        tag.corners[k] = {detection->p[3 - k][0] - 0.5, detection->p[3 - k][1] - 0.5};
    }
    apriltag_detections_destroy(found);
    return tags;
  }

  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_;
};

class ArucoDetector final : public TagDetector {
 public:
  explicit ArucoDetector(cv::aruco::PREDEFINED_DICTIONARY_NAME dictionary)
      : dictionary_(cv::aruco::getPredefinedDictionary(dictionary)),
        parameters_(cv::aruco::DetectorParameters::create()) {
    parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  }

 private:
  std::vector<DetectedTag> find(const cv::Mat& gray) const override {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
    cv::aruco::detectMarkers(gray, dictionary_, corners, ids, parameters_);
    std::vector<DetectedTag> tags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      DetectedTag& tag = tags.emplace_back();
      tag.id = ids[i];
      for (std::size_t k = 0; k < 4; ++k)  // with the clock from the top left already
        tag.corners[k] = {corners[i][k].x, corners[i][k].y};
    }
    return tags;
  }

  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
};

}  // namespace

std::vector<DetectedTag> TagDetector::detect(const cv::Mat& gray) const {
  std::vector<DetectedTag> tags = find(gray);
  std::sort(tags.begin(), tags.end(),
            [](const DetectedTag& a, const DetectedTag& b) { return a.id < b.id; });
  std::vector<DetectedTag> unique;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const bool before = i > 0 && tags[i - 1].id == tags[i].id;
    const bool after = i + 1 < tags.size() && tags[i + 1].id == tags[i].id;
    if (!before && !after) unique.push_back(tags[i]);
  }
  return unique;
}

std::unique_ptr<TagDetector> make_tag_detector(const std::string& family, double decimate) {
  for (const Family& known : kFamilies)
    if (family == known.name) return std::make_unique<AprilTagDetector>(known, decimate);
  for (const auto& [name, dictionary] : kDictionaries)
    if (family == name) return std::make_unique<ArucoDetector>(dictionary);
  throw std::invalid_argument("unknown family of tags '" + family + "'");
}

}  // namespace libslam
