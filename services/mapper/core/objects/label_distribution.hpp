// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/map_file/byte_reader.hpp"
#include "common/map_file/byte_writer.hpp"

namespace rds::mapper {

/// What sightings say of one label.
struct LabelBelief {
  std::string label;
  double probability = 0;
  double share = 0;  // of the evidence for all labels

  bool operator==(const LabelBelief&) const = default;
};

/// The label of an object, as probabilities that its sightings add up to.
///
/// Confusion model: of K labels, a detector that is given one of label c names l with P(l | c) = s for l = c
/// and (1 − s) / (K − 1) for each other, s being its score. A sighting that names l so multiplies the odds of
/// l against every other label by s (K − 1) / (1 − s). Its logarithm is the evidence of one independent
/// sighting; neighbouring keyframes repeat the detector's error, so that several count as one. With e(l)
/// their sum,
///
///   P(l) = exp e(l) / (Σ exp e(named) + K − N),  N labels having been named.
///
/// Sums, so that the order of sightings does not matter and no label is fixed by having come first.
/// Source: recursive Bayes as in McCormac et al. 2017 (SemanticFusion), Eq. (2), for a detector that tells
/// one label and its score instead of all probabilities.
class LabelDistribution {
 public:
  /// @param score  of the detector, 0 … 1.
  void add(const std::string& label, double score);
  void add(const LabelDistribution& other);

  /// The most probable label, of equal ones the first by name. Something must have been added.
  [[nodiscard]] const std::string& best() const;
  /// Labels that have been named, the most probable first; at most `most`.
  [[nodiscard]] std::vector<LabelBelief> beliefs(std::size_t most) const;

  void put(map_file::ByteWriter& writer) const;
  /// Refuses what put() cannot have written, and a distribution without a label.
  static LabelDistribution get(map_file::ByteReader& reader);

 private:
  struct Evidence {
    std::string label;
    double sum = 0;
  };
  void add_evidence(const std::string& label, double evidence);

  std::vector<Evidence> evidence_;  // by label
};

}  // namespace rds::mapper
