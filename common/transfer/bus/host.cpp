// SPDX-License-Identifier: Apache-2.0
#include "common/transfer/bus/host.hpp"

#include <fstream>
#include <string>

#include <sys/stat.h>

namespace rds::transfer {

std::uint64_t this_host() {
  std::string name;  // of this start of this machine
  std::ifstream("/proc/sys/kernel/random/boot_id") >> name;
  struct stat network {};
  if (stat("/proc/self/ns/net", &network) == 0) name += " " + std::to_string(network.st_ino);
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash | 1U;
}

}  // namespace rds::transfer
