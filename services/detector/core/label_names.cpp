// SPDX-License-Identifier: Apache-2.0
#include "services/detector/core/label_names.hpp"

#include <algorithm>
#include <array>

namespace rds::detector {
namespace {

struct Alias {
  std::string_view coco;
  std::string_view voc;
};

constexpr std::array kAliases{
    Alias{"airplane", "aeroplane"},       Alias{"motorcycle", "motorbike"},     Alias{"couch", "sofa"},
    Alias{"potted plant", "pottedplant"}, Alias{"dining table", "diningtable"}, Alias{"tv", "tvmonitor"},
};

}  // namespace

std::string canonical_label(std::string_view label) {
  const auto alias = std::ranges::find(kAliases, label, &Alias::coco);
  return std::string(alias == kAliases.end() ? label : alias->voc);
}

}  // namespace rds::detector
