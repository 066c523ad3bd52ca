#include <array>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <mrpt/img/TStereoCamera.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CObservationStereoImages.h>
#include <mrpt/serialization/CArchive.h>
#include <nlohmann/json.hpp>

#include <libslam/data/ground_truth.hpp>
#include <libslam/frontend/png_image.hpp>
#include <libslam/io/importers/kitti_images.hpp>
#include <libslam/io/input_error.hpp>
#include <libslam/io/input_file.hpp>
#include <libslam/io/text_reader.hpp>
#include <libslam/io/truth_writer.hpp>

namespace libslam {
namespace {

namespace fs = std::filesystem;
using Projection = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

/// The benchmark's sequences were recorded that day; any fixed time serves where none is given.
constexpr double kEpoch = 1317340800.0;  // 2011-09-30 00:00 UTC
constexpr double kPeriod = 0.1;
/// What seven printed digits leave of an orthonormal matrix.
constexpr double kPrinted = 1e-4;

/// Camera axes (X right, Y down, Z forward) in those of the robot (x forward, y left, z up).
const Eigen::Matrix3d kAxes = (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished();

Projection read_matrix(const TextReader& row, std::size_t first) {
  row.require_columns(first + 12);
  Projection m;
  for (std::size_t i = 0; i < 12; ++i) m.data()[i] = row.number(first + i);
  return m;
}

std::array<fs::path, 2> find_image_folders(const fs::path& directory) {
  constexpr std::array<std::array<const char*, 2>, 3> kNames = {
      {{"image_l", "image_r"}, {"image_0", "image_1"}, {"image_2", "image_3"}}};
  for (const auto& [left, right] : kNames)
    if (fs::is_directory(directory / left) && fs::is_directory(directory / right))
      return {directory / left, directory / right};
  throw InputError(directory.string() +
                   ": no folders image_l and image_r, image_0 and image_1, or "
                   "image_2 and image_3");
}

/// With "P0:" to "P3:" the gray cameras are 0 and 1, the colour cameras 2 and 3.
mrpt::img::TStereoCamera read_calibration(const std::string& file, bool colour) {
  std::vector<Projection> rows;
  TextReader row(file);
  while (row.next()) {
    const bool named = row.word(0).ends_with(':');
    if (!named || row.word(0).starts_with("P")) rows.push_back(read_matrix(row, named ? 1 : 0));
  }
  const std::size_t first = colour && rows.size() >= 4 ? 2 : 0;
  if (rows.size() < first + 2) throw InputError(file + ": two projection matrices are needed");
  const Projection &l = rows[first], &r = rows[first + 1];
  const double f = l(0, 0), baseline = (l(0, 3) - r(0, 3)) / f;
  if (!(f > 0.0 && l(1, 1) > 0.0 && baseline > 0.0) || !l.leftCols<3>().isApprox(r.leftCols<3>()))
    throw InputError(file + ": not the matrices of a rectified pair, right camera at the right");
  mrpt::img::TStereoCamera camera;
  camera.leftCamera.setIntrinsicParamsFromValues(f, l(1, 1), l(0, 2), l(1, 2));
  camera.rightCamera = camera.leftCamera;
  camera.rightCameraPose = mrpt::math::TPose3DQuat(baseline, 0, 0, 1, 0, 0, 0);
  return camera;
}

std::vector<double> read_times(const std::string& directory) {
  std::vector<double> times;
  const std::string file = find_optional_input_file(directory, "times.txt");
  if (file.empty()) return times;
  TextReader row(file);
  while (row.next()) {
    times.push_back(kEpoch + row.number(0));
    if (times.size() > 1 && times.back() < times[times.size() - 2])
      row.reject("time goes backwards");
  }
  return times;
}

std::vector<SpatialPose> read_poses(const std::string& directory) {
  std::vector<SpatialPose> poses;
  const std::string file = find_optional_input_file(directory, "poses.txt");
  if (file.empty()) return poses;
  TextReader row(file);
  while (row.next()) {
    const Projection m = read_matrix(row, 0);
    const Eigen::Matrix3d R = m.leftCols<3>();
    if (!(R * R.transpose()).isIdentity(kPrinted) || R.determinant() < 0.0)
      row.reject("the matrix holds no rotation");
    SpatialPose pose;
    pose.position = kAxes * m.col(3);
    pose.rotation = Eigen::Quaterniond(kAxes * R * kAxes.transpose()).normalized();
    poses.push_back(pose);
  }
  return poses;
}

/// Copies one image beside the rawlog and lets the observation name it there.
void place_image(const fs::path& source, const fs::path& folder, const std::string& name,
                 mrpt::img::CImage& image, mrpt::img::TCamera& camera) {
  cv::Size size;
  try {
    size = read_png(source.string()).size();
  } catch (const DamagedPng& defect) {
    throw InputError(source.string() + ": is no image: " + defect.what());
  }
  if (!fs::copy_file(source, folder / name, fs::copy_options::overwrite_existing))
    throw std::runtime_error((folder / name).string() + ": cannot be written");
  fs::permissions(folder / name, fs::perms::owner_write, fs::perm_options::add);  // next import
  image.setExternalStorage(name);
  camera.ncols = static_cast<std::uint32_t>(size.width);
  camera.nrows = static_cast<std::uint32_t>(size.height);
}

std::string notes_text(const std::string& directory, std::int64_t pairs, double baseline) {
  nlohmann::ordered_json notes;
  notes["scenario"] = "KITTI stereo images of " + fs::path(directory).lexically_normal().string();
  notes["has_heading"] = true;
  notes["calibration"] = nlohmann::json::object();
  notes["parameters"] = {{"pairs", pairs}, {"baseline", baseline}};
  notes["remarks"] = {{"path", "left camera with axes x forward, y left, z up"},
                      {"licence", "KITTI: CC BY-NC-SA 3.0"}};
  return notes.dump(2) + "\n";
}

std::string pair_name(std::int64_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "%06lld.png", static_cast<long long>(number));
  return name;
}

/// Removes a file that an exception leaves incomplete.
class IncompleteFile {
 public:
  explicit IncompleteFile(std::string file) : file_(std::move(file)) {}
  IncompleteFile(const IncompleteFile&) = delete;
  IncompleteFile& operator=(const IncompleteFile&) = delete;
  ~IncompleteFile() {
    std::error_code ignored;
    if (!file_.empty()) fs::remove(file_, ignored);
  }
  void complete() { file_.clear(); }

 private:
  std::string file_;
};

/// Throws InputError naming the first image that is missing below the highest number.
void require_all_images(const fs::path& folder) {
  std::int64_t images = 0;
  for (const auto& entry : fs::directory_iterator(folder))
    images += entry.path().extension() == ".png" ? 1 : 0;
  for (std::int64_t k = 0; k < images; ++k)
    if (!fs::exists(folder / pair_name(k)))
      throw InputError((folder / pair_name(k)).string() +
                       ": no such file, though the folder holds " + std::to_string(images) +
                       " images");
}

}  // namespace

KittiImagesSummary import_kitti_images(const std::string& directory, const std::string& rawlog,
                                       const std::function<bool()>& interrupted) {
  const auto folders = find_image_folders(directory);
  auto camera =
      read_calibration(find_input_file(directory, "calib.txt"), folders[0].filename() == "image_2");
  const std::vector<double> times = read_times(directory);
  const std::vector<SpatialPose> poses = read_poses(directory);
  require_all_images(folders[0]);
  remove_truth_beside(rawlog);
  const fs::path images = fs::path(rawlog).replace_extension().string() + "_Images";
  fs::create_directories(images);
  mrpt::io::CFileGZOutputStream out;
  if (!out.open(rawlog)) throw std::runtime_error(rawlog + ": cannot be written");
  IncompleteFile unfinished(rawlog);
  auto archive = mrpt::serialization::archiveUniquePtrFrom(out);
  KittiImagesSummary summary;
  summary.baseline = camera.rightCameraPose.x;
  const Eigen::Quaterniond q(kAxes);
  GroundTruth truth;
  for (std::int64_t k = 0; fs::exists(folders[0] / pair_name(k)); ++k) {
    if (interrupted && interrupted()) {
      summary.complete = false;
      break;
    }
    const auto at = static_cast<std::size_t>(k);
    if (!times.empty() && at >= times.size())
      throw InputError(directory + "/times.txt: has fewer lines than there are pairs");
    const double time = times.empty() ? kEpoch + kPeriod * static_cast<double>(k) : times[at];
    mrpt::obs::CObservationStereoImages pair;
    pair.timestamp = mrpt::Clock::fromDouble(time);
    pair.sensorLabel = "stereo";
    pair.hasImageRight = true;
    place_image(folders[0] / pair_name(k), images, "left_" + pair_name(k), pair.imageLeft,
                camera.leftCamera);
    place_image(folders[1] / pair_name(k), images, "right_" + pair_name(k), pair.imageRight,
                camera.rightCamera);
    pair.setStereoCameraParams(camera);
    pair.cameraPose = mrpt::poses::CPose3DQuat(
        0.0, 0.0, 0.0, mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()));
    *archive << pair;
    ++summary.pairs;
    if (at >= poses.size()) continue;
    truth.path.times.push_back(time);
    truth.path.spatial.push_back(poses[at]);
    ++summary.true_poses;
  }
  if (summary.pairs == 0 && summary.complete)
    throw InputError(folders[0].string() + ": holds no 000000.png");
  archive.reset();
  out.close();
  unfinished.complete();
  write_truth_beside(rawlog, truth, notes_text(directory, summary.pairs, summary.baseline));
  return summary;
}

}  // namespace libslam
