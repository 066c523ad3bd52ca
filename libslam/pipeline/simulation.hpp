#pragma once
// From a scenario to a drive: the checks, the files of the world, the models of the vehicle.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include <libslam/config/validation.hpp>
#include <libslam/simulation/scenario.hpp>
#include <libslam/simulation/simulator.hpp>

namespace libslam {

/// Loads a scenario over the defaults; world files with relative names are taken from the folder of
/// `file`. Throws ConfigError as load_yaml does; combinations are left to `validate`.
Scenario load_scenario(const std::filesystem::path& file, ParameterPlaces* places = nullptr);

/// Makes the names of world files that are relative start at `directory`.
void resolve_world_files(Scenario& scenario, const std::filesystem::path& directory);

/// What the robot of a scenario knows about itself: its nominal vehicle with the noise of the
/// odometry, the odometry field, and the sensor to use with its nominal noise: range and bearing
/// where that is enabled or nothing else is, else points of a stereo camera, else tags in images,
/// else walls in the scans of a laser.
Parameters nominal_filter(const Scenario& scenario);

/// All conflicts between parameters, ranges included.
std::vector<Conflict> find_conflicts(const Scenario& scenario);
/// Throws ConfigError with the first conflict.
void validate(const Scenario& scenario, const ParameterPlaces& places = {});

/// The world of a scenario. Throws InputError "file:line: ..." where a file cannot be used.
World make_world(const Scenario& scenario);

/// The same scenario and seed give the same steps, bit for bit. Throws InputError like make_world,
/// and std::invalid_argument on a value that `validate` would have refused.
std::unique_ptr<Simulator> make_simulator(const Scenario& scenario, std::uint64_t seed);

}  // namespace libslam
