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
  std::filesystem::path dataset;
  double from_s;
};

Source source_of(const std::string& name) {
  if (name == "walkers") {
    const TestRecording people = recording_with_people();
    return {people.folder, people.rendered ? 0.0 : 6.0};
  }
  if (name != "rpy") throw std::runtime_error(name + ": no such recording");
  return {why_not_shared("data/tum_fr1_rpy").empty() ? shared() / "data/tum_fr1_rpy"
                                                     : rendered_recording("room_empty"),
          0};
}

}  // namespace

std::filesystem::path to_and_fro(const std::string& name, const std::filesystem::path& place) {
  const auto [dataset, from_s] = source_of(name);
  make_to_and_fro(dataset, place / name, from_s, kTurnS, kLengthS);
  return place / name;
}

}  // namespace rds::test
