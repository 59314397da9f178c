// SPDX-License-Identifier: Apache-2.0
#include "common/vision/descriptor_matching.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace rds::vision {
namespace {

constexpr int kDescriptorBytes = 32;
constexpr int kFar = 8 * kDescriptorBytes + 1;

struct Nearest {
  int row = -1;
  int distance = kFar;
  int second_distance = kFar;

  void offer(int candidate, int candidate_distance) {
    if (candidate_distance < distance) {
      second_distance = distance;
      distance = candidate_distance;
      row = candidate;
    } else if (candidate_distance < second_distance) {
      second_distance = candidate_distance;
    }
  }
};

void check_form(const cv::Mat& descriptors) {
  if (descriptors.empty()) return;
  if (descriptors.type() != CV_8UC1 || descriptors.cols != kDescriptorBytes || descriptors.dims != 2)
    throw std::invalid_argument("descriptor matching: descriptors must be N×32 CV_8U");
}

}  // namespace

int hamming_distance(const std::uint8_t* a, const std::uint8_t* b) {
  int distance = 0;
  for (int i = 0; i < kDescriptorBytes; i += 8) {
    std::uint64_t word_a = 0;
    std::uint64_t word_b = 0;
    std::memcpy(&word_a, a + i, 8);
    std::memcpy(&word_b, b + i, 8);
    distance += std::popcount(word_a ^ word_b);
  }
  return distance;
}

std::vector<DescriptorMatch> match_descriptors(const cv::Mat& query, const cv::Mat& train,
                                               const DescriptorMatchConfig& config) {
  check_form(query);
  check_form(train);
  std::vector<Nearest> of_query(static_cast<std::size_t>(query.rows));
  std::vector<Nearest> of_train(static_cast<std::size_t>(train.rows));
  for (int i = 0; i < query.rows; ++i) {
    const auto* descriptor = query.ptr<std::uint8_t>(i);
    for (int j = 0; j < train.rows; ++j) {
      const int distance = hamming_distance(descriptor, train.ptr<std::uint8_t>(j));
      of_query[static_cast<std::size_t>(i)].offer(j, distance);
      of_train[static_cast<std::size_t>(j)].offer(i, distance);
    }
  }
  std::vector<DescriptorMatch> matches;
  for (int i = 0; i < query.rows; ++i) {
    const Nearest& nearest = of_query[static_cast<std::size_t>(i)];
    if (nearest.row < 0 || nearest.distance > config.max_distance) continue;
    if (nearest.distance >= config.max_ratio * nearest.second_distance) continue;
    if (of_train[static_cast<std::size_t>(nearest.row)].row != i) continue;
    matches.push_back({i, nearest.row, nearest.distance});
  }
  return matches;
}

}  // namespace rds::vision
