// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "common/map_file/byte_writer.hpp"
#include "common/vision/place_index.hpp"
#include "services/loop_closer/core/keyframe_graph.hpp"
#include "services/loop_closer/core/loop_agreement.hpp"
#include "services/loop_closer/core/loop_closer_config.hpp"
#include "services/loop_closer/core/loop_types.hpp"
#include "services/loop_closer/core/loop_verification.hpp"

namespace rds::loop_closer {

/// Notices that the camera is back at a place it has seen, and corrects the poses of all keyframes.
///
/// Place recognition (earlier keyframes that look alike, not covisible) → geometric verification → several
/// keyframes in a row that ask for the same correction → pose-graph optimisation. Precision comes first: a
/// missed loop costs drift, a wrong one the map. However small the correction, the tracker is told which
/// keyframes see the same place: it fuses their points, and from then on they are covisible. A loop that its
/// points contradict it does not follow; then that loop is taken out again. Features on movable objects and
/// features without depth are ignored.
///
/// A pure function of the calls: same calls, same answers. About 140 kB per keyframe of 1000 features.
/// Source: Mur-Artal & Tardós 2017, §III-D.
class LoopCloser {
 public:
  explicit LoopCloser(const LoopCloserConfig& config = {});

  /// Takes the next keyframe; ids count up within an epoch, and another epoch starts anew.
  ///
  /// A keyframe that is impossible (array lengths that differ, a pose that is not rigid, an id that is not
  /// new) changes nothing; the answer says why.
  LoopAnswer add(const KeyframeFeatures& features);

  /// What is known stays, corrections count from 0 again: those so far are not to be told again.
  void count_anew() { revision_ = 0; }

  /// Forgets what came since the start, or since start_from().
  void reset();

  /// What of the keyframes cannot be told again: their ids, descriptors and points. Not their poses: a saved
  /// map takes the tracker's, which are final.
  [[nodiscard]] map_file::Bytes to_bytes() const { return to_bytes(views_.size()); }
  /// The same of the keyframes of start_from() alone.
  [[nodiscard]] map_file::Bytes start_to_bytes() const { return to_bytes(start_ ? start_->views.size() : 0); }
  /// Goes on from such bytes with the keyframes' final poses, in every epoch from now on. They are not moved
  /// any more. Keyframes after the last pose came while the map was being saved, and are left out.
  /// @return what does not fit; then nothing has changed.
  tl::expected<void, std::string> start_from(std::span<const std::uint8_t> bytes,
                                             std::span<const KeyframePose> poses);

  /// Keyframes that are known, those of a saved map too.
  [[nodiscard]] std::size_t keyframes() const { return graph_.size(); }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Of all keyframes but those that it started from.
  [[nodiscard]] std::vector<KeyframePose> poses() const { return graph_.poses(); }

 private:
  /// Keyframes of a saved map, by ascending id.
  struct Start {
    std::vector<KeyframePose> poses;
    std::vector<KeyframeView> views;
  };
  [[nodiscard]] map_file::Bytes to_bytes(std::size_t keyframes) const;
  [[nodiscard]] std::string why_impossible(const KeyframeFeatures& features) const;
  [[nodiscard]] std::vector<std::size_t> candidates_for(std::size_t query,
                                                        const KeyframeFeatures& features) const;
  [[nodiscard]] std::optional<LoopDetection> detect(std::size_t query, std::size_t candidate) const;
  [[nodiscard]] bool is_believable(const LoopDetection& detection) const;
  bool follows(std::size_t query, const KeyframeFeatures& features);
  /// @return the matches that the poses were corrected by; nothing if there is no loop.
  std::vector<LoopMatch> close_loop(std::size_t query, const KeyframeFeatures& features);

  LoopCloserConfig config_;
  std::shared_ptr<const Start> start_;  // nullptr unless there is a saved map
  std::optional<std::uint64_t> map_epoch_;
  vision::PlaceIndex index_;
  KeyframeGraph graph_;
  std::vector<KeyframeView> views_;  // as in graph_
  std::uint64_t revision_ = 0;
  std::optional<std::size_t> unconfirmed_since_;  // keyframe whose loop the tracker has not followed yet
};

}  // namespace rds::loop_closer
