#include <numeric>

#include <libslam/campaign/recovery.hpp>

namespace libslam {

void Recovery::observe(double elapsed, double error) {
  if (!kidnap_.enabled || recovered_) return;
  if (elapsed < kidnap_.time_s) {
    before_.push_back(error);
    return;
  }
  if (before_.size() < kLevelUpdates) return;
  if (updates_ == 0)
    level_ =
        2.0 / kLevelUpdates * std::accumulate(before_.end() - kLevelUpdates, before_.end(), 0.0);
  ++updates_;
  recovered_ = error < level_;
}

nlohmann::ordered_json Recovery::figures() const {
  if (updates_ == 0) return nullptr;
  nlohmann::ordered_json out = {{"never", recovered_ ? 0 : 1}};
  if (recovered_) out["updates"] = updates_;
  return out;
}

}  // namespace libslam
