// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/record/topic_choice.hpp"

#include <algorithm>
#include <array>

#include "common/topics/table.hpp"
#include "common/topics/topics.hpp"

namespace rds::record {
namespace {

constexpr const char* kStaticTransforms = "tf_static";  // of the robot

/// What services tell each other: keyframes' pictures, which the camera's topics have, and transfers of large
/// data.
const std::array<std::string, 9> kInternal{
    topics::kKeyframeImages.name, topics::kKeyframeFeatures.name, topics::kTransferPrefix,
    topics::kMapOffers.name,      topics::kMapRequests.name,      topics::kMapChunks.name,
    topics::kRunReply.name,       topics::kCommandResult.name,    topics::kServiceStatus.name};

bool is_internal(const std::string& topic) {
  return std::ranges::any_of(kInternal, [&](const std::string& start) { return topic.starts_with(start); });
}

}  // namespace

TopicChoice TopicChoice::camera() {
  return named({topics::kColor.name, topics::kCameraInfo.name, topics::kDepth.name, kStaticTransforms});
}

TopicChoice TopicChoice::camera_and_outputs() {
  TopicChoice choice = camera();
  for (const auto service :
       {topics::kTracker, topics::kDetector, topics::kTransformer, topics::kMapper, topics::kLoopCloser})
    for (const std::string& topic : topics::written_by(service))
      if (!is_internal(topic)) choice.topics_.insert(topic);
  return choice;
}

TopicChoice TopicChoice::all() {
  TopicChoice choice;
  choice.all_ = true;
  return choice;
}

TopicChoice TopicChoice::named(const std::vector<std::string>& topics) {
  TopicChoice choice;
  for (const std::string& topic : topics) choice.topics_.insert(topic.substr(topic.starts_with('/') ? 1 : 0));
  return choice;
}

bool TopicChoice::contains(const std::string& topic) const {
  return all_ || topics_.contains(topic);
}

}  // namespace rds::record
