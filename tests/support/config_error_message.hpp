#pragma once
// What a configuration error says.

#include <string>

#include <gtest/gtest.h>

#include <libslam/config/config_error.hpp>

namespace libslam::test {

/// The message of the ConfigError that `action` throws, checked to be one line; fails if it throws
/// none.
template <typename Action>
std::string config_error_message(Action&& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  ADD_FAILURE() << "no ConfigError was thrown";
  return "";
}

}  // namespace libslam::test
