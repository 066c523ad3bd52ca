#pragma once
// How a struct of parameters describes itself: its member `void describe(auto& v)` calls
//
//   v.value(name, T& field, Describe{...});   T one of bool, int, double, std::string
//   v.section(name, Sub& sub);                Sub described in the same way
//
// for every field in the order in which people should read them. parameter_table.hpp does the rest.

#include <limits>
#include <string_view>
#include <vector>

namespace libslam {

/// What the description says about a parameter besides its name.
struct Describe {
  std::string_view unit;  ///< "m", "rad", "1" ...
  std::string_view text;  ///< one sentence
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string_view> choices = {};  ///< of a string parameter; empty: any
};

}  // namespace libslam
