// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/map/map_diff.hpp"


#include <fmt/format.h>

#include "services/mapper/core/octree/label_table.hpp"
#include "services/mapper/core/octree/voxel_walk.hpp"

namespace rds::tools {
namespace {

using octomap::ColorOcTree;
using octomap::ColorOcTreeNode;
using octomap::OcTreeKey;
using enum VoxelState;
using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb kOnlyInA{214, 39, 40};
constexpr Rgb kOnlyInB{44, 160, 44};
constexpr Rgb kRelabelled{31, 119, 180};
constexpr Rgb kSame{190, 190, 190};

VoxelState state_of(const ColorOcTree& tree, const ColorOcTreeNode* node) {
  if (node == nullptr) return kUnknown;
  return tree.isNodeOccupied(node) ? kOccupied : kFree;
}

Rgb color_of(const ColorOcTreeNode& node) {
  const auto color = node.getColor();
  return {color.r, color.g, color.b};
}

class Comparison {
 public:
  Comparison(const ComparedMap& a, const ComparedMap& b, std::vector<ColoredPoint>* points)
      : a_(a), b_(b), labels_of_a_(a.labels), labels_of_b_(b.labels), points_(points) {}

  MapDifference compare() {
    mapper::for_each_voxel(a_.tree, [&](const OcTreeKey& key, const ColorOcTreeNode& in_a) {
      compare(key, &in_a, b_.tree.search(key));
    });
    mapper::for_each_voxel(b_.tree, [&](const OcTreeKey& key, const ColorOcTreeNode& in_b) {
      if (a_.tree.search(key) == nullptr) compare(key, nullptr, &in_b);
    });
    return std::move(difference_);
  }

 private:
  void compare(const OcTreeKey& key, const ColorOcTreeNode* in_a, const ColorOcTreeNode* in_b) {
    const VoxelState state_a = state_of(a_.tree, in_a);
    const VoxelState state_b = state_of(b_.tree, in_b);
    ++difference_.voxels[static_cast<std::size_t>(state_a)][static_cast<std::size_t>(state_b)];
    bool is_relabelled = false;
    if (state_a == state_b) {
      difference_.other_value += in_a->getLogOdds() != in_b->getLogOdds() ? 1U : 0U;
      if (state_a == kOccupied) is_relabelled = compare_labels(*in_a, *in_b);
    }
    if (state_a != state_b || is_relabelled) extend_bounds(key);
    if (points_ != nullptr && (state_a == kOccupied || state_b == kOccupied))
      points_->push_back({center_of(key).cast<float>(), state_a == state_b
                                                            ? (is_relabelled ? kRelabelled : kSame)
                                                        : state_a == kOccupied ? kOnlyInA
                                                                               : kOnlyInB});
  }

  bool compare_labels(const ColorOcTreeNode& in_a, const ColorOcTreeNode& in_b) {
    const Rgb color_a = color_of(in_a);
    const Rgb color_b = color_of(in_b);
    difference_.other_color += color_a != color_b ? 1U : 0U;
    const std::string label_a = name_of(a_, labels_of_a_.label_of(color_a));
    const std::string label_b = name_of(b_, labels_of_b_.label_of(color_b));
    if (a_.labels.empty() || b_.labels.empty() || label_a == label_b) return false;
    ++difference_.relabelled[{label_a, label_b}];
    return true;
  }

  static std::string name_of(const ComparedMap& map, std::uint16_t label) {
    return label == 0 ? std::string() : map.labels[label];
  }

  [[nodiscard]] Eigen::Vector3d center_of(const OcTreeKey& key) const {
    return {a_.tree.keyToCoord(key[0]), a_.tree.keyToCoord(key[1]), a_.tree.keyToCoord(key[2])};
  }

  void extend_bounds(const OcTreeKey& key) {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(a_.tree.getResolution() / 2);
    difference_.bounds.extend(center_of(key) - half);
    difference_.bounds.extend(center_of(key) + half);
  }

  const ComparedMap& a_;
  const ComparedMap& b_;
  mapper::ColorLabels labels_of_a_;
  mapper::ColorLabels labels_of_b_;
  std::vector<ColoredPoint>* points_;
  MapDifference difference_;
};

std::string quoted(const std::string& label) {
  return label.empty() ? "no label" : label;
}

}  // namespace

bool MapDifference::has_same_states() const {
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      if (a != b && voxels[a][b] > 0) return false;
  return true;
}

bool MapDifference::is_equal() const {
  return has_same_states() && other_value == 0 && other_color == 0 && relabelled.empty();
}

MapDifference compare_maps(const ComparedMap& a, const ComparedMap& b, std::vector<ColoredPoint>* points) {
  return Comparison(a, b, points).compare();
}

std::string describe(const MapDifference& d, bool states_only) {
  const std::uint64_t both = d.count(kOccupied, kOccupied);
  const std::uint64_t in_a = d.count(kOccupied, kFree) + d.count(kOccupied, kUnknown);
  const std::uint64_t in_b = d.count(kFree, kOccupied) + d.count(kUnknown, kOccupied);
  const auto share = [&](std::uint64_t count) {
    return both + in_a + in_b == 0
               ? 0.0
               : 100.0 * static_cast<double>(count) / static_cast<double>(both + in_a + in_b);
  };
  std::string text =
      fmt::format("occupied in both  {:>9}  {:5.1f} % of what is occupied in either\n", both, share(both));
  text += fmt::format("only in A         {:>9}  {:5.1f} %  in B: {} free, {} unknown\n", in_a, share(in_a),
                      d.count(kOccupied, kFree), d.count(kOccupied, kUnknown));
  text += fmt::format("only in B         {:>9}  {:5.1f} %  in A: {} free, {} unknown\n", in_b, share(in_b),
                      d.count(kFree, kOccupied), d.count(kUnknown, kOccupied));
  text += fmt::format("free in both      {:>9}           free in A alone: {}, in B alone: {}\n",
                      d.count(kFree, kFree), d.count(kFree, kUnknown), d.count(kUnknown, kFree));
  if (!states_only) {
    text += fmt::format("other log-odds    {:>9}           of voxels with the same state\n", d.other_value);
    text += fmt::format("other colour      {:>9}           of voxels occupied in both\n", d.other_color);
    std::uint64_t relabelled = 0;
    for (const auto& [labels, count] : d.relabelled) relabelled += count;
    text += fmt::format("other label       {:>9}\n", relabelled);
    for (const auto& [labels, count] : d.relabelled)
      text += fmt::format("  {:>25}  {} -> {}\n", count, quoted(labels.first), quoted(labels.second));
  }
  if (!d.bounds.isEmpty())
    text += fmt::format("between           [{:.2f} {:.2f} {:.2f}] and [{:.2f} {:.2f} {:.2f}] m\n",
                        d.bounds.min().x(), d.bounds.min().y(), d.bounds.min().z(), d.bounds.max().x(),
                        d.bounds.max().y(), d.bounds.max().z());
  return text;
}

}  // namespace rds::tools
