// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/recordings.hpp"

#include <stdexcept>

#include "tests/support/disturbed_dataset.hpp"
#include "tests/support/shared_data.hpp"

namespace rds::test {
namespace {

constexpr double kTurnS = 4;
constexpr double kLengthS = 30;

/// A recording, and where the part begins in which people, if any, come and go [s].
struct Source {
  RecordingPair whole;
  double from_s;
};

Source source_of(const std::string& name) {
  if (name == "walkers") {
    const TestRecording people = recording_with_people();
    if (people.rendered) return {{people.folder, rendered_recording("room_empty")}, 0};
    return {{people.folder, shared() / "data/7scenes_kitchen"}, 6};
  }
  if (name != "rpy") throw std::runtime_error(name + ": no such recording");
  const auto folder = why_not_shared("data/tum_fr1_rpy").empty() ? shared() / "data/tum_fr1_rpy"
                                                                 : rendered_recording("room_empty");
  return {{folder, {}}, 0};
}

}  // namespace

RecordingPair to_and_fro(const std::string& name, const std::filesystem::path& place) {
  const auto [whole, from_s] = source_of(name);
  make_to_and_fro(whole.dataset, place / name, from_s, kTurnS, kLengthS);
  if (whole.background.empty()) return {place / name, {}};
  make_to_and_fro(whole.background, place / (name + "_background"), from_s, kTurnS, kLengthS);
  return {place / name, place / (name + "_background")};
}

}  // namespace rds::test
