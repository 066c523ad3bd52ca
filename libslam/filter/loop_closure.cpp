#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <libslam/filter/loop_closure.hpp>
#include <libslam/measurement/relative_pose.hpp>
#include <libslam/state/planar_pose.hpp>

namespace libslam {

namespace {

constexpr double kViewLength = 6.0;        // of the way behind a view [m]
constexpr double kPointSpacing = 0.3;      // of a view [m]
constexpr std::size_t kFewestPoints = 80;  // fewer are a wall or two
constexpr double kMeeting = 1.0;           // paths meet so far beyond the window [m]
constexpr double kPendingWay = 12.0;       // a match waits so long for others [m]
constexpr double kInPlaceXY = 0.3;         // corrections that association makes itself [m]
constexpr double kInPlaceHeading = 2.0 * std::numbers::pi / 180.0;  // [rad]
constexpr double kInPlaceSupport = 0.05;                            // beyond the least
// Half a cell of the raster and what its spacing of headings leaves; a match may be off by twice
// that relative to another one, as both stretches have drifted meanwhile.
constexpr double kSigmaXY = 0.05;                                       // [m]
constexpr double kSigmaHeading = 0.3 * std::numbers::pi / 180.0;        // [rad]
constexpr double kSigmaMutualXY = 0.1;                                  // [m]
constexpr double kSigmaMutualHeading = 1.0 * std::numbers::pi / 180.0;  // [rad]
constexpr int kLinearizations = 10;
// Most stretches that a view is searched in, and where it fits another one as it is.
constexpr std::size_t kSearches = 2, kSearchesInPlace = 1;

bool is_small(const Eigen::Vector3d& correction) {
  return correction.head<2>().norm() < kInPlaceXY && std::abs(correction.z()) < kInPlaceHeading;
}

}  // namespace

LoopClosure::LoopClosure(const LoopClosureOptions& options)
    : options_(options), update_(kLinearizations) {
  if (!(options.window.xy > 0.0) || !(options.window.heading > 0.0) || options.confirmations < 1)
    throw std::invalid_argument("loop closure needs a window and a confirmation");
}

std::vector<LoopClosure::NearStretch> LoopClosure::near_stretches(
    const GaussianState& state) const {
  const auto places = path_.places();
  const Eigen::Vector2d here = places.back().T_world_place(state).head<2>();
  const double last_way = places[path_.recent(kViewLength).first].way - options_.min_way;
  std::vector<NearStretch> near;
  for (std::size_t k = 0; k < path_.stretches().size(); ++k) {
    const PathStretch& stretch = path_.stretches()[k];
    if (places[stretch.last - 1].way > last_way) break;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = stretch.first; i < stretch.last; ++i)
      distance = std::min(distance, (places[i].T_world_place(state).head<2>() - here).norm());
    if (distance < options_.window.xy + kMeeting) near.push_back({distance, k});
  }
  std::stable_sort(near.begin(), near.end(), [](const NearStretch& a, const NearStretch& b) {
    return a.distance < b.distance;
  });
  return near;
}

const SurfaceGrid& LoopClosure::grid(const GaussianState& state, std::size_t stretch) {
  const PathStretch& part = path_.stretches()[stretch];
  const auto places = path_.places();
  const Eigen::Vector3d T_first_last = relative_pose(places[part.first].T_world_place(state),
                                                     places[part.last - 1].T_world_place(state));
  const auto known = grids_.find(stretch);
  if (known != grids_.end()) {
    const Eigen::Vector3d bent = relative_pose(known->second.T_first_last, T_first_last);
    if (bent.head<2>().norm() < kSigmaXY && std::abs(bent.z()) < kSigmaHeading)
      return known->second.grid;
    grids_.erase(known);
  }
  StretchGrid made{T_first_last, SurfaceGrid(path_.scans(state, part, part.middle()))};
  return grids_.emplace(stretch, std::move(made)).first->second.grid;
}

void LoopClosure::keep_grids(std::span<const NearStretch> near) {
  std::erase_if(grids_, [&](const auto& entry) {
    return std::none_of(near.begin(), near.end(),
                        [&](const NearStretch& stretch) { return stretch.stretch == entry.first; });
  });
}

bool LoopClosure::in_place(const SurfaceGrid& raster, std::span<const Eigen::Vector2d> view,
                           const Eigen::Vector3d& T_old_new) const {
  const Eigen::Vector3d close_by = raster.refine(view, T_old_new);
  return is_small(relative_pose(T_old_new, close_by)) &&
         raster.score(view, close_by).support >= options_.min_support + kInPlaceSupport;
}

std::optional<LoopMatch> LoopClosure::match(std::span<const Eigen::Vector2d> view,
                                            const SurfaceGrid& raster, LoopMatch there) {
  ++counts_.searches;
  const auto usable = [&](const SurfaceMatch& match) {
    return match.score.contradicted <= options_.max_contradicted &&
           !is_small(relative_pose(there.T_old_new, match.T_grid_view));
  };
  const auto found = raster.search(view, there.T_old_new, options_.window, options_.min_support,
                                   options_.min_margin, usable);
  if (!found) return std::nullopt;
  ++counts_.matches;
  if (found->score.contradicted > options_.max_contradicted) ++counts_.contradicted;
  if (!usable(*found)) return std::nullopt;
  if (found->score.support - found->rival < options_.min_margin) {
    ++counts_.ambiguous;
    return std::nullopt;
  }
  there.T_estimate_match = relative_pose(there.T_old_new, found->T_grid_view);
  there.T_old_new = found->T_grid_view;
  return there;
}

std::vector<LoopMatch> LoopClosure::find(const GaussianState& state) {
  std::vector<LoopMatch> found;
  const std::vector<NearStretch> near = near_stretches(state);
  keep_grids(near);
  if (near.empty()) return found;
  const auto places = path_.places();
  const std::size_t here = places.size() - 1;
  const std::vector<Eigen::Vector2d> view =
      thinned_points(path_.scans(state, path_.recent(kViewLength), here), kPointSpacing);
  if (view.size() < kFewestPoints) return found;
  std::vector<NearStretch> out_of_place;
  for (const NearStretch& candidate : near) {
    const Eigen::Vector3d T_old_new =
        relative_pose(places[path_.stretches()[candidate.stretch].middle()].T_world_place(state),
                      places[here].T_world_place(state));
    if (!in_place(grid(state, candidate.stretch), view, T_old_new))
      out_of_place.push_back(candidate);
  }
  const std::size_t fitting = near.size() - out_of_place.size();
  counts_.in_place += static_cast<std::int64_t>(fitting);
  out_of_place.resize(std::min(out_of_place.size(), fitting > 0 ? kSearchesInPlace : kSearches));
  for (const NearStretch& candidate : out_of_place) {
    const std::size_t old = path_.stretches()[candidate.stretch].middle();
    const Eigen::Vector3d T_old_new =
        relative_pose(places[old].T_world_place(state), places[here].T_world_place(state));
    if (const auto there =
            match(view, grid(state, candidate.stretch), {old, here, T_old_new, T_old_new}))
      found.push_back(*there);
  }
  return found;
}

bool LoopClosure::agree(const GaussianState& state, const LoopMatch& a, const LoopMatch& b) const {
  const auto places = path_.places();
  const auto found = [&](const LoopMatch& match) {
    return compose_poses(places[match.old_place].T_world_place(state), match.T_old_new);
  };
  const Eigen::Vector3d driven = relative_pose(places[a.new_place].T_world_place(state),
                                               places[b.new_place].T_world_place(state));
  const Eigen::Vector3d misfit = relative_pose(relative_pose(found(a), found(b)), driven);
  const double xy = misfit.head<2>().norm() / kSigmaMutualXY;
  const double heading = misfit.z() / kSigmaMutualHeading;
  return xy * xy + heading * heading <= options_.joint_gate;
}

std::vector<LoopMatch> LoopClosure::agreeing(const GaussianState& state,
                                             const LoopMatch& match) const {
  const auto places = path_.places();
  std::vector<LoopMatch> together{match};
  for (auto other = pending_.rbegin(); other != pending_.rend(); ++other) {
    const double apart = places[together.back().new_place].way - places[other->new_place].way;
    if (other->new_place != match.new_place && apart >= options_.confirmation_distance &&
        agree(state, *other, match))
      together.push_back(*other);
  }
  return together;
}

bool LoopClosure::close(GaussianState& state, Ekf& ekf, BlockId pose,
                        std::span<const LoopMatch> matches) {
  const Eigen::Matrix3d cov =
      Eigen::Vector3d(kSigmaXY, kSigmaXY, kSigmaHeading).cwiseAbs2().asDiagonal();
  const auto linearize = [&](std::size_t i, LinearizedMeasurement& out) {
    const SeenPlace &from = path_.places()[matches[i].old_place],
                    &to = path_.places()[matches[i].new_place];
    const Eigen::Vector3d T_place_kept = relative_pose(to.T_kept_place, Eigen::Vector3d::Zero());
    const Eigen::Vector3d T_from_to =
        compose_poses(compose_poses(from.T_kept_place, matches[i].T_old_new), T_place_kept);
    linearize_relative_pose(state, from.kept, to.kept, T_from_to, cov, out);
  };
  std::vector<LinearizedMeasurement> stacked(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) linearize(i, stacked[i]);
  if (!update_.correct(state, ekf, pose, stacked, {}, linearize).applied) return false;
  ++counts_.closures;
  closed_.insert(closed_.end(), matches.begin(), matches.end());
  pending_.clear();
  return true;
}

bool LoopClosure::look(GaussianState& state, Ekf& ekf, BlockId pose, BlockId kept,
                       std::span<const Eigen::Vector2d> points) {
  if (!path_.remember(state, pose, kept, points)) return false;
  const double way = path_.places().back().way;
  std::erase_if(pending_, [&](const LoopMatch& match) {
    return way - path_.places()[match.new_place].way > kPendingWay;
  });
  std::vector<LoopMatch> best;
  for (const LoopMatch& match : find(state)) {
    std::vector<LoopMatch> together = agreeing(state, match);
    if (together.size() > best.size()) best = std::move(together);
    pending_.push_back(match);
  }
  return best.size() >= static_cast<std::size_t>(options_.confirmations) &&
         close(state, ekf, pose, best);
}

void LoopClosure::restart() {
  path_.restart();
  pending_.clear();
}

std::map<std::string, double> LoopClosure::figures() const {
  return {{"loop_views_in_place", static_cast<double>(counts_.in_place)},
          {"loop_searches", static_cast<double>(counts_.searches)},
          {"loop_matches", static_cast<double>(counts_.matches)},
          {"loop_matches_ambiguous", static_cast<double>(counts_.ambiguous)},
          {"loop_matches_contradicted", static_cast<double>(counts_.contradicted)},
          {"loop_matches_used", static_cast<double>(closed_.size())},
          {"loop_closures", static_cast<double>(counts_.closures)}};
}

}  // namespace libslam
