// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/record/topic_choice.hpp"

#include <algorithm>
#include <array>

#include "common/topics/table.hpp"
#include "common/topics/topics.hpp"

namespace rds::record {
namespace {

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
  return named({topics::kColor.name, topics::kCameraInfo.name, topics::kDepth.name,
                topics::kRobotOdometry.name, topics::kImu.name, topics::kStaticTransforms.address()});
}

TopicChoice TopicChoice::outputs() {
  TopicChoice choice;
  for (const auto service :
       {topics::kTracker, topics::kDetector, topics::kTransformer, topics::kMapper, topics::kLoopCloser})
    for (const topics::Row& row : topics::table())
      if (row.is_written_by(service) && !is_internal(row.name)) choice.topics_.insert(row.address());
  return choice;
}

TopicChoice TopicChoice::camera_and_outputs() {
  TopicChoice choice = camera();
  choice.topics_.merge(outputs().topics_);
  return choice;
}

TopicChoice TopicChoice::all() {
  TopicChoice choice;
  choice.all_ = true;
  return choice;
}

TopicChoice TopicChoice::named(const std::vector<std::string>& topics) {
  TopicChoice choice;
  choice.topics_.insert(topics.begin(), topics.end());
  return choice;
}

TopicChoice TopicChoice::by_full_names(
    const std::function<std::string(const std::string&)>& full_name) const {
  TopicChoice choice;
  choice.all_ = all_;
  for (const std::string& topic : topics_) choice.topics_.insert(full_name(topic));
  return choice;
}

bool TopicChoice::contains(const std::string& topic) const {
  return all_ || topics_.contains(topic) || topics_.contains("/" + topic);
}

}  // namespace rds::record
