// SPDX-License-Identifier: Apache-2.0
#include "common/dynamic_segmentation/markov_field.hpp"

#include "common/dynamic_segmentation/cell_rows.hpp"

namespace rds::segmentation {
namespace {

constexpr int kRounds = 2;

/// What the cells of a grid have been told by their neighbours in one direction.
struct Messages {
  explicit Messages(const cv::Size& size) : down(size, 0.0F), up(size, 0.0F) {}
  cv::Mat1f down;  // by the row before
  cv::Mat1f up;    // by the row after
};

/// From one row to the next to it. @param told  what came so far in this direction.
void pass(const cv::Mat1f& beliefs, const cv::Mat1f& couplings, int coupling, int from, int to,
          cv::Mat1f& told) {
  const auto held = row_of(couplings, coupling);
  row_of(told, to) = (row_of(beliefs, from) + row_of(told, from)).max(-held).min(held);
}

/// From row to row and back: a whole row at a time.
/// @param beliefs  of each cell, without what it was told in these directions.
void sweep(const cv::Mat1f& beliefs, const cv::Mat1f& couplings, Messages& told) {
  for (int r = 1; r < beliefs.rows; ++r) pass(beliefs, couplings, r - 1, r - 1, r, told.down);
  for (int r = beliefs.rows - 2; r >= 0; --r) pass(beliefs, couplings, r, r + 1, r, told.up);
}

}  // namespace

cv::Mat1f propagate(const cv::Mat1f& log_odds, const Couplings& couplings) {
  const cv::Mat1f turned_couplings(couplings.right.t());  // rows are the picture's columns
  Messages across(turned_couplings.size());
  Messages along(log_odds.size());
  cv::Mat1f from_sides;
  cv::Mat1f believed = log_odds;  // without what the cells beside it say
  for (int round = 0; round < kRounds; ++round) {
    sweep(cv::Mat1f(believed.t()), turned_couplings, across);
    from_sides = cv::Mat(across.down + across.up).t();
    sweep(cv::Mat1f(log_odds + from_sides), couplings.below, along);
    believed = cv::Mat1f(log_odds + along.down + along.up);  // not into the memory of `log_odds`
  }
  return cv::Mat1f(believed + from_sides);
}

}  // namespace rds::segmentation
