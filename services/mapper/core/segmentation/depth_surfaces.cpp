// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/segmentation/depth_surfaces.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace rds::mapper {
namespace {

constexpr int kNoReturnRadius = 4;  // sampled pixels
constexpr std::uint32_t kMinPixels = 8;

/// Disjoint sets of runs; the lowest one stands for its set.
class RunSets {
 public:
  /// @return a set of its own.
  std::uint32_t add() {
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    return parent_.back();
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

bool may_be_static(PixelClass c) {
  return looks_static(c) || c == PixelClass::kUnknown;
}

/// Pixels of a row that are connected one by one.
struct Run {
  std::uint32_t first;
  std::uint32_t end;
};

/// The runs of a picture in order, and which of them are connected.
class Runs {
 public:
  explicit Runs(const KeyframeRecord& record) : record_(record), above_(width()), row_(width()) {
    for (std::size_t first = 0; first < record.size(); first += width()) {
      add_row(static_cast<std::uint32_t>(first));
      std::swap(above_, row_);
    }
  }
  /// Calls visit(run, the first run of its surface) for each run.
  template <class Visit>
  void for_each(Visit visit) {
    for (std::uint32_t i = 0; i < runs_.size(); ++i) visit(i, sets_.root(i));
  }
  [[nodiscard]] std::size_t size() const { return runs_.size(); }
  [[nodiscard]] const Run& operator[](std::size_t run) const { return runs_[run]; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFF'FFFF;

  [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(record_.grid.width); }

  void add_row(std::uint32_t first) {
    const std::uint16_t* depths = &record_.depth_tenth_mm[first];
    const PixelClass* classes = &record_.classes[first];
    const SurfaceSteps& steps = record_.grid.rays->surface_steps();
    const std::size_t width = this->width();
    std::uint32_t run = kNone;
    std::uint32_t joined = kNone;  // the run above that it was joined with last
    for (std::uint32_t x = 0; x < width; ++x) {
      if (!may_be_static(classes[x])) {
        row_[x] = run = kNone;
        continue;
      }
      const int depth = depths[x];
      const int step = steps.at(depths[x]);
      const auto is_connected = [&](int other) { return std::abs(other - depth) <= step; };
      if (run == kNone || !is_connected(depths[x - 1])) {
        run = sets_.add();
        runs_.push_back({first + x, first + x});
        joined = kNone;
      }
      row_[x] = run;
      ++runs_[run].end;
      if (first == 0 || above_[x] == kNone || above_[x] == joined) continue;
      if (!is_connected(*(depths + x - width))) continue;
      joined = above_[x];
      sets_.join(run, joined);
    }
  }

  const KeyframeRecord& record_;
  RunSets sets_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> above_;  // the run of each pixel in the row before
  std::vector<std::uint32_t> row_;
};

}  // namespace

cv::Mat1b without_depth_all_around(const KeyframeRecord& record) {
  cv::Mat1b none(record.grid.height, record.grid.width);
  std::ranges::transform(record.depth_tenth_mm, none.begin(), [](std::uint16_t depth) {
    return depth == 0 ? std::uint8_t{255} : std::uint8_t{0};
  });
  const int side = 2 * kNoReturnRadius + 1;
  cv::erode(none, none, cv::getStructuringElement(cv::MORPH_RECT, {side, side}), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  return none;
}

bool is_on_surface(const KeyframeRecord& record, int column, int row, int edge_support) {
  const int width = record.grid.width;
  const std::uint16_t* middle = &record.depth_tenth_mm[record.grid.index(column, row)];
  const int depth = *middle;
  const int tolerance = record.grid.rays->surface_steps().at(*middle);
  const auto near = [&](int r, int c) {
    return std::abs(middle[r * width + c] - depth) <= tolerance ? 1 : 0;
  };
  const bool has_all = column > 0 && row > 0 && column + 1 < width && row + 1 < record.grid.height;
  if (has_all) {
    int count = near(0, -1) + near(0, 1) + near(-1, 0);  // mostly enough
    if (count >= edge_support) return true;
    count += near(1, 0) + near(-1, -1) + near(-1, 1) + near(1, -1) + near(1, 1);
    return count >= edge_support;
  }
  int count = -1;  // itself
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, record.grid.height - 1); ++r)
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, width - 1); ++c)
      count += near(r - row, c - column);
  return count >= edge_support;
}

std::uint16_t find_surfaces(const KeyframeRecord& record, std::vector<std::uint16_t>& surface) {
  Runs runs(record);
  std::vector<std::uint32_t> pixels(runs.size(), 0);  // of the surface that begins with a run
  runs.for_each(
      [&](std::uint32_t run, std::uint32_t first) { pixels[first] += runs[run].end - runs[run].first; });
  std::vector<std::uint16_t> numbers(runs.size(), 0);
  std::uint16_t surfaces = 0;
  surface.assign(record.size(), 0);
  runs.for_each([&](std::uint32_t run, std::uint32_t first) {
    if (run == first && pixels[run] >= kMinPixels && surfaces < std::numeric_limits<std::uint16_t>::max())
      numbers[run] = ++surfaces;
    std::fill(surface.begin() + runs[run].first, surface.begin() + runs[run].end, numbers[first]);
  });
  return surfaces;
}

}  // namespace rds::mapper
