// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/markov_field.hpp"

#include <algorithm>

namespace rds::segmentation {
namespace {

constexpr int kRounds = 2;

/// What a cell has been told by its neighbours.
struct Messages {
  explicit Messages(const cv::Size& size)
      : left(size, 0.0F), right(size, 0.0F), above(size, 0.0F), below(size, 0.0F) {}
  cv::Mat1f left;  // by the cell left of it
  cv::Mat1f right;
  cv::Mat1f above;
  cv::Mat1f below;
};

float held(float message, float coupling) {
  return std::clamp(message, -coupling, coupling);
}

void sweep_rows(const cv::Mat1f& own, const cv::Mat1f& couplings, Messages& told) {
  for (int r = 0; r < own.rows; ++r) {
    const float* u = own[r];
    const float* above = told.above[r];
    const float* below = told.below[r];
    const float* k = couplings[r];
    float* left = told.left[r];
    float* right = told.right[r];
    for (int c = 1; c < own.cols; ++c)
      left[c] = held(u[c - 1] + above[c - 1] + below[c - 1] + left[c - 1], k[c - 1]);
    for (int c = own.cols - 2; c >= 0; --c)
      right[c] = held(u[c + 1] + above[c + 1] + below[c + 1] + right[c + 1], k[c]);
  }
}

/// @param from, to  rows, next to each other. @param along  what came so far in this direction.
void pass(const cv::Mat1f& own, const float* couplings, int from, int to, const Messages& told,
          cv::Mat1f& along) {
  const float* u = own[from];
  const float* left = told.left[from];
  const float* right = told.right[from];
  const float* before = along[from];
  float* after = along[to];
  for (int c = 0; c < own.cols; ++c) after[c] = held(u[c] + left[c] + right[c] + before[c], couplings[c]);
}

void sweep_columns(const cv::Mat1f& own, const cv::Mat1f& couplings, Messages& told) {
  for (int r = 1; r < own.rows; ++r) pass(own, couplings[r - 1], r - 1, r, told, told.above);
  for (int r = own.rows - 2; r >= 0; --r) pass(own, couplings[r], r + 1, r, told, told.below);
}

}  // namespace

cv::Mat1f propagate(const cv::Mat1f& log_odds, const Couplings& couplings) {
  Messages told(log_odds.size());
  for (int round = 0; round < kRounds; ++round) {
    sweep_rows(log_odds, couplings.right, told);
    sweep_columns(log_odds, couplings.below, told);
  }
  return cv::Mat1f(log_odds + told.left + told.right + told.above + told.below);
}

}  // namespace rds::segmentation
