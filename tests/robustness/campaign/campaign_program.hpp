#pragma once
// slam-campaign as people and scripts see it.

#include <chrono>
#include <filesystem>
#include <functional>
#include <signal.h>
#include <string>
#include <support/program_run.hpp>
#include <thread>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

namespace libslam::test {

inline const std::string kCampaign = LIBSLAM_SLAM_CAMPAIGN;

class CampaignProgram : public ProgramTest {
 protected:
  /// Two filters, drives of four seconds.
  void SetUp() override {
    config_ = write("mc.yaml", R"(
campaign: {runs: 3}
scenario:
  world: {landmarks: 40, size_x: 60, size_y: 60}
  drive: {max_duration_s: 4}
  motion: {model: ackermann, ackermann_form: seed, wheelbase: 4}
variants:
  standard: {filter: {error_frame: standard}}
  invariant:
)");
  }

  std::string to(const std::string& name) const { return " --out " + path(name); }
  nlohmann::json campaign(const std::string& name) const {
    return nlohmann::json::parse(read_all(path(name + "/campaign.json")));
  }
  /// campaign.json without any `timing`.
  std::string results(const std::string& name) const {
    return without_timing(campaign(name)).dump();
  }

  void expect_one_line(const Outcome& outcome, int code, const std::string& text) const {
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  }

  /// Starts `command`, sends it `signal` once its journal holds results, and gives its exit code.
  int run_and_signal(std::vector<std::string> command, const std::string& name, int signal) const {
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> arguments;
      for (std::string& word : command) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(97);
      if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(97);
      execvp(arguments[0], arguments.data());
      _exit(98);
    }
    wait_for_results(name);
    kill(child, signal);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  std::string config_;

 private:
  static nlohmann::json without_timing(nlohmann::json value) {
    if (value.is_object()) value.erase("timing");
    if (value.is_structured())
      for (auto& part : value) part = without_timing(part);
    return value;
  }

  void wait_for_results(const std::string& name) const {
    std::error_code ignored;
    const std::filesystem::path journal = path(name + "/runs.journal");
    for (int i = 0; i < 3000; ++i) {
      const auto size = std::filesystem::file_size(journal, ignored);
      if (!ignored && size > 2000) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "no results within 30 s";
  }
};

}  // namespace libslam::test
