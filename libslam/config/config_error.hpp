#pragma once
// The one exception of the configuration layer.

#include <stdexcept>

namespace libslam {

/// A configuration that cannot be used. `what()` is one line: place, what is wrong, what would be
/// right.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace libslam
