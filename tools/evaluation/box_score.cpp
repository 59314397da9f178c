// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluation/box_score.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

namespace rds::evaluation {
namespace {
using geometry::Box2;
using nlohmann::json;

constexpr double kWarmUpS = 1.0;
constexpr double kSameInstantS = 0.005;
constexpr double kMinVisible = 0.5;
constexpr double kMinArea = 2500.0 / (640 * 480);  // of the picture
constexpr double kHitIou = 0.5;

Box2 box_from(const json& numbers) {
  return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>(),
          numbers.at(3).get<double>()};
}

/// A time as a number or as its decimal text.
double time_from(const json& value) {
  return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
}

PredictedFrame predicted_frame(const json& line) {
  PredictedFrame frame;
  frame.time_s = time_from(line.at("stamp"));
  for (const auto& box : line.at("boxes"))
    if (box.value("label", "") == "person") frame.boxes.push_back(box_from(box.at("box")));
  return frame;
}

bool overlap(const Box2& a, const Box2& b) {
  return std::min(a.x1, b.x1) > std::max(a.x0, b.x0) && std::min(a.y1, b.y1) > std::max(a.y0, b.y0);
}

cv::Rect pixels_of(const Box2& box, const cv::Size& picture) {
  const Box2 inside = box.clipped(picture.width, picture.height);
  const auto whole = [](double v) { return static_cast<int>(std::nearbyint(v)); };
  const int x0 = whole(inside.x0);
  const int y0 = whole(inside.y0);
  return {x0, y0, std::max(0, whole(inside.x1) - x0), std::max(0, whole(inside.y1) - y0)};
}

/// Sums over frames, divided at the end.
class Tally {
 public:
  explicit Tally(const cv::Size& picture) : picture_(picture) {}

  void add(const PeopleFrame& frame, const std::vector<Box2>& boxes) {
    cv::Mat covered = cv::Mat::zeros(picture_, CV_8UC1);
    int wasted = 0;
    for (const auto& box : boxes) {
      const cv::Rect pixels = pixels_of(box, picture_);
      covered(pixels).setTo(1);
      if (std::ranges::none_of(frame.people, [&](const auto& person) { return overlap(box, person.box); }))
        wasted += pixels.area();
    }
    waste_ += static_cast<double>(wasted) / picture_.area();
    ++frames_;
    for (const auto& person : frame.people)
      if (person.visible_fraction > kMinVisible && person.area_px > kMinArea * picture_.area())
        add_person(person, boxes, covered);
  }

  [[nodiscard]] BoxScore score() const {
    const auto n = static_cast<double>(people_);
    return {people_, static_cast<double>(hits_) / std::max(1.0, n), iou_ / n, cover_ / n,
            waste_ / static_cast<double>(frames_)};
  }

 private:
  void add_person(const PersonTruth& person, const std::vector<Box2>& boxes, const cv::Mat& covered) {
    double best = 0;
    for (const auto& box : boxes) best = std::max(best, geometry::iou(person.box, box));
    ++people_;
    hits_ += best > kHitIou ? 1 : 0;
    iou_ += best;
    cover_ += cv::mean(covered(pixels_of(person.box, picture_)))[0];
  }

  cv::Size picture_;
  std::size_t frames_ = 0;
  std::size_t people_ = 0;
  std::size_t hits_ = 0;
  double iou_ = 0;
  double cover_ = 0;
  double waste_ = 0;
};

}  // namespace

tl::expected<std::vector<PeopleFrame>, std::string> read_people(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in)
    return tl::unexpected(fmt::format("{}: cannot be read, expected the people's true boxes", file.string()));
  try {
    std::vector<PeopleFrame> frames;
    const json whole = json::parse(in);
    for (const auto& entry : whole.at("frames")) {
      PeopleFrame frame{time_from(entry.at("timestamp")), {}};
      for (const auto& person : entry.at("people"))
        frame.people.push_back({box_from(person.at("box")), person.at("visible_fraction").get<double>(),
                                person.at("area").get<double>()});
      frames.push_back(std::move(frame));
    }
    if (frames.empty())
      return tl::unexpected(fmt::format("{}: no frames, expected at least one", file.string()));
    return frames;
  } catch (const std::exception& e) {
    return tl::unexpected(
        fmt::format("{}: expected frames with timestamp and people (box, visible_fraction, area): {}",
                    file.string(), e.what()));
  }
}

tl::expected<std::vector<PredictedFrame>, std::string> read_predictions(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) return tl::unexpected(fmt::format("{}: cannot be read, expected predicted boxes", file.string()));
  std::vector<PredictedFrame> frames;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    try {
      frames.push_back(predicted_frame(json::parse(line)));
    } catch (const std::exception& e) {
      return tl::unexpected(
          fmt::format("{}:{}: expected {{\"stamp\": …, \"boxes\": [{{\"label\", \"box\"}}]}}: {}",
                      file.string(), number, e.what()));
    }
  }
  std::ranges::stable_sort(frames, {}, &PredictedFrame::time_s);
  return frames;
}

BoxScore score_boxes(const std::vector<PeopleFrame>& truth, const std::vector<PredictedFrame>& predictions,
                     const cv::Size& picture) {
  Tally tally(picture);
  for (const auto& frame : truth) {
    if (frame.time_s - truth.front().time_s < kWarmUpS) continue;
    const auto found =
        std::ranges::lower_bound(predictions, frame.time_s - kSameInstantS, {}, &PredictedFrame::time_s);
    const bool same = found != predictions.end() && std::abs(found->time_s - frame.time_s) < kSameInstantS;
    tally.add(frame, same ? found->boxes : std::vector<Box2>());
  }
  return tally.score();
}

}  // namespace rds::evaluation
