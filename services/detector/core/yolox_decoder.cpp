// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/detector/core/decoder.hpp"
#include "services/detector/core/detection.hpp"

namespace rds::detector {
namespace {

struct Cell {
  double column = 0;
  double row = 0;
  double stride = 0;  // [px] of the input
};

std::vector<Cell> cells_of(const NetworkDescription& network) {
  std::vector<Cell> cells;
  for (const int stride : network.decoder.strides)
    for (int row = 0; row < network.input.height / stride; ++row)
      for (int column = 0; column < network.input.width / stride; ++column)
        cells.push_back({static_cast<double>(column), static_cast<double>(row), static_cast<double>(stride)});
  return cells;
}

class YoloxDecoder final : public Decoder {
 public:
  explicit YoloxDecoder(const NetworkDescription& network)
      : labels_(static_cast<int>(network.labels.size())), cells_(cells_of(network)) {}

  [[nodiscard]] std::vector<Candidate> decode(std::span<const NamedTensor> outputs,
                                              float min_score) const override {
    if (outputs.size() != 1)
      throw DetectorError(fmt::format("the network: expected one output, got {}", outputs.size()));
    const cv::Mat rows = as_rows(outputs[0], 5 + labels_);
    if (rows.rows != static_cast<int>(cells_.size()))
      throw DetectorError(fmt::format("output '{}' of the network: expected {} rows (one per cell), got {}",
                                      outputs[0].name, cells_.size(), rows.rows));
    std::vector<Candidate> candidates;
    for (int i = 0; i < rows.rows; ++i) {
      const auto* row = rows.ptr<float>(i);
      if (!(row[4] >= min_score)) continue;
      const float* best = std::max_element(row + 5, row + 5 + labels_);
      const float score = row[4] * *best;
      const geometry::Box2 box = decode_box(row, cells_[static_cast<std::size_t>(i)]);
      if (score >= min_score && std::isfinite(box.area()))
        candidates.push_back({static_cast<int>(best - row) - 5, score, box});
    }
    return candidates;
  }

 private:
  static geometry::Box2 decode_box(const float* row, const Cell& cell) {
    const double x = (row[0] + cell.column) * cell.stride;
    const double y = (row[1] + cell.row) * cell.stride;
    const double half_width = std::exp(row[2]) * cell.stride / 2;
    const double half_height = std::exp(row[3]) * cell.stride / 2;
    return {x - half_width, y - half_height, x + half_width, y + half_height};
  }

  int labels_;
  std::vector<Cell> cells_;
};

}  // namespace

std::unique_ptr<Decoder> make_yolox_decoder(const NetworkDescription& network) {
  return std::make_unique<YoloxDecoder>(network);
}

}  // namespace rds::detector
