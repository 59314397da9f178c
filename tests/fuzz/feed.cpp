// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/feed.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/fuzz/allocation_watch.hpp"

namespace rds::fuzz {
namespace {

constexpr std::size_t kDefaultInputs = 1'000'000;

std::size_t inputs_of_a_reader(std::size_t share_percent) {
  const char* text = std::getenv("RDS_FUZZ_INPUTS");
  const std::size_t all = text != nullptr ? std::strtoull(text, nullptr, 10) : kDefaultInputs;
  return all * share_percent / 100;
}

}  // namespace

void feed(std::size_t share_percent, const std::vector<Bytes>& seeds,
          const std::function<std::size_t(std::size_t)>& bound,
          const std::function<bool(const Bytes&)>& read) {
  for (const Bytes& seed : seeds) EXPECT_TRUE(read(seed)) << "what is not spoiled is accepted";
  Mutation mutation(share_percent);
  std::size_t accepted = 0;
  std::size_t most_memory = 0;
  const std::size_t inputs = inputs_of_a_reader(share_percent);
  const auto started = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < inputs; ++i) {
    const Bytes input = mutation.of(seeds);
    const AllocationWatch watch;
    accepted += read(input) ? 1U : 0U;
    most_memory = std::max(most_memory, watch.peak_bytes());
    if (watch.peak_bytes() > bound(input.size())) {
      ADD_FAILURE() << "input " << i << " of " << input.size() << " bytes took " << watch.peak_bytes()
                    << " bytes of memory, expected at most " << bound(input.size());
      return;
    }
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  std::cout << inputs << " inputs, " << accepted << " accepted, at most " << most_memory
            << " bytes of memory, " << took.count() << " s\n";
  EXPECT_LT(accepted, inputs) << "nothing was spoiled";
}

}  // namespace rds::fuzz
