// SPDX-License-Identifier: Apache-2.0
#include "services/mapper/core/objects/label_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace rds::mapper {
namespace {

constexpr double kLabels = 80;  // K: COCO's, more than any shipped network knows
/// Sightings that count as one that is independent: the next keyframe shows the same side of an object.
constexpr double kRepeated = 2;
// Scores of networks say little at their ends: evidence is neither against the named label nor endless.
constexpr double kLowestScore = 0.05;
constexpr double kHighestScore = 0.95;

}  // namespace

void LabelDistribution::add(const std::string& label, double score) {
  const double s = std::clamp(score, kLowestScore, kHighestScore);
  add_evidence(label, std::log(s * (kLabels - 1) / (1 - s)) / kRepeated);
}

void LabelDistribution::add(const LabelDistribution& other) {
  for (const Evidence& evidence : other.evidence_) add_evidence(evidence.label, evidence.sum);
}

void LabelDistribution::add_evidence(const std::string& label, double evidence) {
  auto at = std::ranges::lower_bound(evidence_, label, {}, &Evidence::label);
  if (at == evidence_.end() || at->label != label) at = evidence_.insert(at, {label, 0});
  at->sum += evidence;
}

const std::string& LabelDistribution::best() const {
  return std::ranges::max_element(evidence_, {}, &Evidence::sum)->label;  // the first of equal ones
}

std::vector<LabelBelief> LabelDistribution::beliefs(std::size_t most) const {
  if (evidence_.empty()) return {};
  const double highest = std::ranges::max_element(evidence_, {}, &Evidence::sum)->sum;
  const double others = std::max(0.0, kLabels - static_cast<double>(evidence_.size()));
  double odds = others * std::exp(-highest);  // all relative to the highest, so that nothing overflows
  double sum = 0;
  for (const Evidence& e : evidence_) {
    odds += std::exp(e.sum - highest);
    sum += e.sum;
  }
  std::vector<LabelBelief> beliefs;
  for (const Evidence& e : evidence_)
    beliefs.push_back({e.label, std::exp(e.sum - highest) / odds, e.sum / sum});
  std::ranges::stable_sort(beliefs, std::greater(), &LabelBelief::share);
  beliefs.resize(std::min(beliefs.size(), most));
  return beliefs;
}

void LabelDistribution::put(map_file::ByteWriter& writer) const {
  writer.put_count(evidence_.size());
  for (const Evidence& evidence : evidence_) {
    writer.put_text(evidence.label);
    writer.put(evidence.sum);
  }
}

LabelDistribution LabelDistribution::get(map_file::ByteReader& reader) {
  LabelDistribution labels;
  labels.evidence_.resize(reader.get_count(sizeof(std::uint64_t) + sizeof(double)));
  for (std::size_t i = 0; i < labels.evidence_.size() && reader.ok(); ++i) {
    Evidence& evidence = labels.evidence_[i];
    evidence = {reader.get_text(), reader.get<double>()};
    if (i > 0 && evidence.label <= labels.evidence_[i - 1].label) reader.refuse("labels out of order");
    if (!(evidence.sum > 0)) reader.refuse("a label that nothing speaks for");
  }
  if (labels.evidence_.empty()) reader.refuse("an object without a label");
  return labels;
}

}  // namespace rds::mapper
