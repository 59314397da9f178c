// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/colour_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace rds::segmentation {
namespace {

// Luma and two differences of colour (ITU-R BT.601), those near grey finer than the strong ones.
constexpr int kLumas = 8;
constexpr int kStrongest = 5;  // steps from grey
constexpr int kChromas = 2 * kStrongest + 1;
constexpr float kChromaStep = 6;
constexpr int kColours = kLumas * kChromas * kChromas;

using Histogram = std::vector<float>;  // kColours; luma, then one difference, then the other

int chroma(float difference) {
  constexpr float kEnd = kStrongest;
  return static_cast<int>(std::clamp(difference / kChromaStep, -kEnd, kEnd) + kEnd + 0.5F);
}

std::uint16_t colour_of(float red, float green, float blue) {
  const float luma = 0.299F * red + 0.587F * green + 0.114F * blue;
  const int level = std::min(kLumas - 1, static_cast<int>(luma) * kLumas / 256);
  const int index = (level * kChromas + chroma(0.713F * (red - luma))) * kChromas +
                    chroma(0.564F * (blue - luma));
  return static_cast<std::uint16_t>(index);
}

/// Half of each colour's share goes to the two next to it along one of the histogram's axes.
/// @param stride  between neighbours along it. @param length  of it.
void blur(Histogram& histogram, int stride, int length) {
  const Histogram sharp = histogram;
  for (int i = 0; i < kColours; ++i) {
    const int along = i / stride % length;
    const int below = along > 0 ? i - stride : i;
    const int above = along + 1 < length ? i + stride : i;
    histogram[i] = 0.5F * sharp[i] + 0.25F * (sharp[below] + sharp[above]);
  }
}

/// Logarithm of each colour's probability.
Histogram log_probabilities(Histogram counts, float prior) {
  blur(counts, 1, kChromas);
  blur(counts, kChromas, kChromas);
  blur(counts, kChromas * kChromas, kLumas);
  const float all = std::accumulate(counts.begin(), counts.end(), prior * kColours);
  for (float& count : counts) count = std::log((count + prior) / all);
  return counts;
}

}  // namespace

ColourCells colours_in_cells(const image::ColorImage& picture, const cv::Size& size, int cell_px) {
  const cv::Mat& pixels = picture.pixels;
  const int red = picture.order == image::ChannelOrder::kRgb ? 0 : 2;
  const int offset = cell_px / 4;
  const int step = cell_px / 2;
  ColourCells cells(size);
  for (int r = 0; r < size.height; ++r) {
    const int y = r * cell_px + offset;
    const cv::Vec3b* upper = pixels.ptr<cv::Vec3b>(std::min(pixels.rows - 1, y));
    const cv::Vec3b* lower = pixels.ptr<cv::Vec3b>(std::min(pixels.rows - 1, y + step));
    for (int c = 0; c < size.width; ++c) {
      const int left = std::min(pixels.cols - 1, c * cell_px + offset);
      const int right = std::min(pixels.cols - 1, left + step);
      const auto mean = [&](int channel) {
        return 0.25F * static_cast<float>(upper[left][channel] + upper[right][channel] +
                                          lower[left][channel] + lower[right][channel]);
      };
      cells(r, c) = colour_of(mean(red), mean(1), mean(2 - red));
    }
  }
  return cells;
}

cv::Mat1f colour_ratio(const ColourCells& colours, const cv::Mat1f& log_odds, const EvidenceModel& model) {
  Histogram movable(kColours, 0);
  Histogram fixed(kColours, 0);
  for (int r = 0; r < colours.rows; ++r)
    for (int c = 0; c < colours.cols; ++c) ++(log_odds(r, c) > 0 ? movable : fixed)[colours(r, c)];
  movable = log_probabilities(std::move(movable), model.colour_prior);
  fixed = log_probabilities(std::move(fixed), model.colour_prior);
  cv::Mat1f ratio(colours.size());
  for (int r = 0; r < colours.rows; ++r)
    for (int c = 0; c < colours.cols; ++c) {
      const std::uint16_t colour = colours(r, c);
      ratio(r, c) = model.colour_weight * (movable[colour] - fixed[colour]);
    }
  return ratio;
}

}  // namespace rds::segmentation
