// SPDX-License-Identifier: Apache-2.0
#include "common/vision/place_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace rds::vision {
namespace {

constexpr int kDescriptorBytes = 32;
constexpr int kSignatureOffset = 24;
constexpr int kSignatureBits = 64;
constexpr int kTables = 6;  // hash tables, each with a word of two bytes; at most 12 lie in front of the signature
constexpr int kMaxSignatureBits = 9;  // a posting counts if at most so many bits differ: kAgreementSigma of 64
constexpr std::size_t kWords = 1U << 16U;
constexpr double kAgreementSigma = 0.15;  // share of bits that differ between two views of a point

void check_form(const cv::Mat& descriptors) {
  if (descriptors.empty()) return;
  if (descriptors.type() != CV_8UC1 || descriptors.cols != kDescriptorBytes || descriptors.dims != 2)
    throw std::invalid_argument("place index: descriptors must be N×32 CV_8U");
}

std::uint16_t word_of(const std::uint8_t* descriptor, int table) {
  std::uint16_t word = 0;
  std::memcpy(&word, descriptor + 2 * table, sizeof word);
  return word;
}

std::size_t bucket_of(int table, std::uint16_t word) {
  return static_cast<std::size_t>(table) * kWords + word;
}

std::array<std::uint32_t, 2> signature_of(const std::uint8_t* descriptor) {
  std::array<std::uint32_t, 2> signature{};
  std::memcpy(signature.data(), descriptor + kSignatureOffset, sizeof signature);
  return signature;
}

}  // namespace

/// What a query has found so far, by slot.
struct PlaceIndex::Tally {
  explicit Tally(std::size_t slots) : weight(slots, 0.0), matches(slots, 0), distance(slots, kUnseen) {}

  static constexpr int kUnseen = kSignatureBits + 1;
  std::vector<double> weight;
  std::vector<int> matches;
  double total_weight = 0;
  std::vector<int> distance;       // of the current feature's best hit in the slot
  std::vector<std::uint32_t> hit;  // slots the current feature has hit
};

PlaceIndex::PlaceIndex() : buckets_(kTables * kWords) {
  for (int bits = 0; bits <= kMaxSignatureBits; ++bits) {
    const double share = bits / (kAgreementSigma * kSignatureBits);
    agreement_.push_back(std::exp(-share * share));
  }
}

void PlaceIndex::add(std::uint64_t id, const cv::Mat& descriptors) {
  check_form(descriptors);
  remove(id);
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(keyframes_.size()));
    keyframes_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  slot_of_id_[id] = slot;
  Keyframe& keyframe = keyframes_[slot];
  keyframe.id = id;
  keyframe.words.reserve(static_cast<std::size_t>(descriptors.rows) * kTables);
  for (int row = 0; row < descriptors.rows; ++row) {
    const auto* descriptor = descriptors.ptr<std::uint8_t>(row);
    for (int table = 0; table < kTables; ++table) {
      const std::uint16_t word = word_of(descriptor, table);
      buckets_[bucket_of(table, word)].push_back({slot, signature_of(descriptor)});
      keyframe.words.push_back(word);
    }
  }
}

void PlaceIndex::remove(std::uint64_t id) {
  const auto found = slot_of_id_.find(id);
  if (found == slot_of_id_.end()) return;
  const std::uint32_t slot = found->second;
  Keyframe& keyframe = keyframes_[slot];
  for (std::size_t i = 0; i < keyframe.words.size(); ++i)
    std::erase_if(buckets_[bucket_of(static_cast<int>(i % kTables), keyframe.words[i])],
                  [slot](const Posting& posting) { return posting.slot == slot; });
  keyframe = Keyframe{};
  free_slots_.push_back(slot);
  slot_of_id_.erase(found);
}

void PlaceIndex::clear() {
  *this = PlaceIndex();
}

/// Best agreement of one feature in every slot it hits.
void PlaceIndex::collect_hits(const std::uint8_t* descriptor, Tally& tally) const {
  const auto signature = signature_of(descriptor);
  for (int table = 0; table < kTables; ++table) {
    for (const Posting& posting : buckets_[bucket_of(table, word_of(descriptor, table))]) {
      const int distance = std::popcount(posting.signature[0] ^ signature[0]) +
                           std::popcount(posting.signature[1] ^ signature[1]);
      if (distance > kMaxSignatureBits || distance >= tally.distance[posting.slot]) continue;
      if (tally.distance[posting.slot] == Tally::kUnseen) tally.hit.push_back(posting.slot);
      tally.distance[posting.slot] = distance;
    }
  }
}

/// Adds the feature's hits to the slots' weights, by inverse document frequency.
void PlaceIndex::count_hits(Tally& tally) const {
  // Half a keyframe more in the numerator, so that a feature seen everywhere still says a little.
  const double idf =
      std::log((static_cast<double>(size()) + 1.0) / (static_cast<double>(tally.hit.size()) + 0.5));
  tally.total_weight += idf;
  for (const std::uint32_t slot : tally.hit) {
    tally.weight[slot] += idf * agreement_[static_cast<std::size_t>(tally.distance[slot])];
    ++tally.matches[slot];
    tally.distance[slot] = Tally::kUnseen;
  }
  tally.hit.clear();
}

std::vector<PlaceCandidate> PlaceIndex::query(const cv::Mat& descriptors, std::size_t max_candidates) const {
  check_form(descriptors);
  Tally tally(keyframes_.size());
  for (int row = 0; row < descriptors.rows; ++row) {
    collect_hits(descriptors.ptr<std::uint8_t>(row), tally);
    count_hits(tally);
  }
  std::vector<PlaceCandidate> candidates;
  for (std::size_t slot = 0; slot < keyframes_.size(); ++slot)
    if (tally.matches[slot] > 0)
      candidates.push_back(
          {keyframes_[slot].id, tally.weight[slot] / tally.total_weight, tally.matches[slot]});
  const auto kept = static_cast<std::ptrdiff_t>(std::min(max_candidates, candidates.size()));
  std::partial_sort(candidates.begin(), candidates.begin() + kept, candidates.end(),
                    [](const PlaceCandidate& a, const PlaceCandidate& b) {
                      return a.score != b.score ? a.score > b.score : a.id < b.id;
                    });
  candidates.resize(static_cast<std::size_t>(kept));
  return candidates;
}

}  // namespace rds::vision
