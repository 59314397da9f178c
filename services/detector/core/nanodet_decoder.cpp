// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/detector/core/decoder.hpp"
#include "services/detector/core/detection.hpp"

namespace rds::detector {
namespace {

/// Mean of a distribution over 0 … bins − 1 given by its logits (softmax).
double expected_bin(const float* logits, int bins) {
  const float largest = *std::max_element(logits, logits + bins);
  double sum = 0;
  double weighted = 0;
  for (int i = 0; i < bins; ++i) {
    const double weight = std::exp(static_cast<double>(logits[i] - largest));
    sum += weight;
    weighted += i * weight;
  }
  return weighted / sum;
}

class NanodetDecoder final : public Decoder {
 public:
  explicit NanodetDecoder(const NetworkDescription& network)
      : input_(network.input), decoder_(network.decoder), labels_(static_cast<int>(network.labels.size())) {}

  [[nodiscard]] std::vector<Candidate> decode(std::span<const NamedTensor> outputs,
                                              float min_score) const override {
    std::vector<Candidate> candidates;
    for (const int stride : decoder_.strides) {
      const cv::Mat scores = rows_of(outputs, stride, labels_);
      const cv::Mat distances = rows_of(outputs, stride, 4 * decoder_.bins);
      append_map(scores, distances, stride, min_score, candidates);
    }
    return candidates;
  }

 private:
  [[nodiscard]] int columns(int stride) const { return (input_.width + stride - 1) / stride; }
  [[nodiscard]] int rows(int stride) const { return (input_.height + stride - 1) / stride; }

  /// The one output with a row per cell and `width` values in it. Exporters do not agree on the outputs'
  /// names.
  [[nodiscard]] cv::Mat rows_of(std::span<const NamedTensor> outputs, int stride, int width) const {
    const auto cells = static_cast<std::size_t>(columns(stride)) * static_cast<std::size_t>(rows(stride));
    const auto fits = [&](const NamedTensor& t) {
      return t.values.total() == cells * static_cast<std::size_t>(width);
    };
    if (std::ranges::count_if(outputs, fits) != 1)
      throw DetectorError(
          fmt::format("the network: expected one output of {} × {} values for stride {}, got {}", cells,
                      width, stride, std::ranges::count_if(outputs, fits)));
    return as_rows(*std::ranges::find_if(outputs, fits), width);
  }

  void append_map(const cv::Mat& scores, const cv::Mat& distances, int stride, float min_score,
                  std::vector<Candidate>& candidates) const {
    for (int i = 0; i < scores.rows; ++i) {
      const auto* score = scores.ptr<float>(i);
      const float* best = std::max_element(score, score + labels_);
      if (!(*best >= min_score)) continue;
      const geometry::Box2 box = decode_box(distances.ptr<float>(i), i, stride);
      if (std::isfinite(box.area())) candidates.push_back({static_cast<int>(best - score), *best, box});
    }
  }

  [[nodiscard]] geometry::Box2 decode_box(const float* logits, int cell, int stride) const {
    const int row = cell / columns(stride);
    const int column = cell % columns(stride);
    const double x = (column + 0.5) * stride - 0.5;
    const double y = (row + 0.5) * stride - 0.5;
    const auto distance = [&](int side) {
      return stride * expected_bin(logits + side * decoder_.bins, decoder_.bins);
    };
    return {x - distance(0), y - distance(1), x + distance(2), y + distance(3)};
  }

  InputDescription input_;
  DecoderDescription decoder_;
  int labels_;
};

}  // namespace

std::unique_ptr<Decoder> make_nanodet_decoder(const NetworkDescription& network) {
  return std::make_unique<NanodetDecoder>(network);
}

}  // namespace rds::detector
