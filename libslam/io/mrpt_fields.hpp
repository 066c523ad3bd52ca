#pragma once
// Fields of MRPT objects that files may hold in a form that cannot be used as it is.

#include <cstring>
#include <optional>

#include <mrpt/system/datetime.h>

namespace libslam {

/// Stamp as seconds since 1970; nothing where MRPT's stamp is invalid.
inline std::optional<double> stamp_seconds(mrpt::system::TTimeStamp stamp) {
  if (stamp == INVALID_TIMESTAMP) return std::nullopt;
  return mrpt::Clock::toDouble(stamp);
}

/// Old logs hold bytes other than 0 and 1 in flags, which no C++ expression may read as bool.
/// Makes such a flag false; true if that was needed.
inline bool mend_flag(bool& flag) {
  unsigned char byte = 0;
  std::memcpy(&byte, &flag, 1);
  if (byte <= 1) return false;
  flag = false;
  return true;
}

}  // namespace libslam
