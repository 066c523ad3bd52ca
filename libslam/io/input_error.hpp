#pragma once
// The one exception of everything that reads files: programs map it to exit code 4.

#include <stdexcept>

namespace libslam {

/// Input that cannot be read or is rejected. `what()` is one line that names the file and the place
/// in it ("file: entry 12: ...", "file:34: ...").
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace libslam
