// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/host.hpp"

#include <fstream>
#include <functional>
#include <string>

#include <sys/stat.h>

namespace rds::transfer {

std::uint64_t this_host() {
  std::string name;  // of this start of this machine
  std::ifstream("/proc/sys/kernel/random/boot_id") >> name;
  struct stat network {};
  if (stat("/proc/self/ns/net", &network) == 0) name += " " + std::to_string(network.st_ino);
  return std::hash<std::string>{}(name) | 1U;
}

}  // namespace rds::transfer
