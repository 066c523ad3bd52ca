#include <algorithm>

#include <libslam/io/truth_writer.hpp>
#include <libslam/map/csv_text.hpp>

namespace libslam {

std::string landmarks_text(const std::vector<TrueLandmark>& landmarks) {
  const bool spatial = std::ranges::any_of(
      landmarks, [](const TrueLandmark& landmark) { return landmark.position.size() > 2; });
  std::string text = spatial ? "id,x,y,z\n" : "id,x,y\n";
  for (const TrueLandmark& landmark : landmarks) {
    append_number(text, landmark.id);
    for (const double coordinate : landmark.position) {
      text += ',';
      append_number(text, coordinate);
    }
    text += '\n';
  }
  return text;
}

}  // namespace libslam
