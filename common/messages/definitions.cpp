// SPDX-License-Identifier: Apache-2.0
#include "common/messages/definitions.hpp"

#include <algorithm>

namespace rds::messages {

std::string_view definition_of(std::string_view ros_name) {
  const auto all = definitions();
  const auto found = std::ranges::lower_bound(all, ros_name, {}, &Definition::ros_name);
  return found != all.end() && found->ros_name == ros_name ? found->text : std::string_view();
}

}  // namespace rds::messages
