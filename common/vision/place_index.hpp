// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <opencv2/core.hpp>

namespace rds::vision {

/// A keyframe that looks like the query.
struct PlaceCandidate {
  std::uint64_t id = 0;
  double score = 0;  // 0 … 1: share of the query's weight that was found again in this keyframe; 1 for itself
  int matches = 0;  // features of the query found again

  bool operator==(const PlaceCandidate&) const = default;
};

/// Appearance index over keyframes' binary descriptors: finds keyframes that show the same place.
///
/// Needs no trained vocabulary. Sixteen bits of a descriptor are a word (locality-sensitive hashing:
/// descriptors of one point share some words); per table an inverted file lists which keyframe holds which
/// word. A posting counts only if 64 further bits nearly agree (Hamming embedding), the more the better they
/// agree, which makes a hit nearly a descriptor match. Features seen in many keyframes weigh less (inverse
/// document frequency).
///
/// A score is meaningful by itself: ORB features of another room reach .02, of the same view .03 to 1.
/// Deterministic: the answer does not depend on the order of insertion. Const members may run at the same
/// time. Memory: about 90 bytes per feature with six tables. Source: Gionis, Indyk & Motwani 1999 (bit
/// sampling); Jégou, Douze & Schmid 2008 (Hamming embedding); Sivic & Zisserman 2003 (inverted file, tf-idf).
class PlaceIndex {
 public:
  PlaceIndex();

  /// Adds a keyframe; one with this id that is already there is replaced.
  /// @param descriptors  N×32 CV_8U, may be empty. @throws std::invalid_argument for another form.
  void add(std::uint64_t id, const cv::Mat& descriptors);

  /// Forgets a keyframe; unknown ids are ignored.
  void remove(std::uint64_t id);

  void clear();

  [[nodiscard]] std::size_t size() const { return slot_of_id_.size(); }
  [[nodiscard]] bool contains(std::uint64_t id) const { return slot_of_id_.contains(id); }

  /// The keyframes most like `descriptors`, best first (equal scores: smaller id first).
  /// @param descriptors  as in add(). @throws std::invalid_argument for another form.
  [[nodiscard]] std::vector<PlaceCandidate> query(const cv::Mat& descriptors,
                                                  std::size_t max_candidates) const;

 private:
  struct Posting {
    std::uint32_t slot;
    std::array<std::uint32_t, 2> signature;
  };
  struct Keyframe {
    std::uint64_t id = 0;
    std::vector<std::uint16_t> words;  // one per table and feature
  };
  struct Tally;

  void collect_hits(const std::uint8_t* descriptor, Tally& tally) const;
  void count_hits(Tally& tally) const;

  std::vector<double> agreement_;              // weight of a hit by differing signature bits
  std::vector<std::vector<Posting>> buckets_;  // tables × 2^16
  std::vector<Keyframe> keyframes_;            // by slot; freed slots are reused
  std::vector<std::uint32_t> free_slots_;
  std::unordered_map<std::uint64_t, std::uint32_t> slot_of_id_;
};

}  // namespace rds::vision
