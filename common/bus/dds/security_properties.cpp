// SPDX-License-Identifier: Apache-2.0
#include "common/bus/dds/security_properties.hpp"

#include <dlfcn.h>

namespace rds::bus::detail {
namespace fs = std::filesystem;
namespace {

/// Debian keeps the plug-ins in a folder beside libddsc.so that is not searched for libraries.
std::string cyclonedds_plugin(const std::string& name) {
  Dl_info library{};
  void* function = dlsym(RTLD_DEFAULT, "dds_create_participant");
  if (function == nullptr || dladdr(function, &library) == 0) return name;
  const fs::path folder = fs::path(library.dli_fname).parent_path();
  const std::string file = "lib" + name + ".so";
  for (const fs::path& candidate : {folder / "libddsc0debian" / file, folder / file})
    if (fs::exists(candidate)) return candidate.string();
  return name;
}

void append_plugin(Properties& properties, const std::string& kind, const std::string& library,
                   const std::string& function) {
  const std::string prefix = "dds.sec." + kind + ".library.";
  properties.emplace_back(prefix + "path", cyclonedds_plugin(library));
  properties.emplace_back(prefix + "init", "init_" + function);
  properties.emplace_back(prefix + "finalize", "finalize_" + function);
}

}  // namespace

Properties fastdds_security(const Credentials& credentials) {
  const std::string authentication = "dds.sec.auth.builtin.PKI-DH.";
  const std::string access = "dds.sec.access.builtin.Access-Permissions.";
  const std::string file = "file://";
  return {{"dds.sec.auth.plugin", "builtin.PKI-DH"},
          {authentication + "identity_ca", file + credentials.ca.string()},
          {authentication + "identity_certificate", file + credentials.certificate.string()},
          {authentication + "private_key", file + credentials.key.string()},
          {"dds.sec.access.plugin", "builtin.Access-Permissions"},
          {access + "permissions_ca", file + credentials.ca.string()},
          {access + "governance", file + credentials.governance.string()},
          {access + "permissions", file + credentials.permissions.string()},
          {"dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC"}};
}

Properties cyclonedds_security(const Credentials& credentials) {
  const std::string file = "file:";
  Properties properties{{"dds.sec.auth.identity_ca", file + credentials.ca.string()},
                        {"dds.sec.auth.identity_certificate", file + credentials.certificate.string()},
                        {"dds.sec.auth.private_key", file + credentials.key.string()},
                        {"dds.sec.access.permissions_ca", file + credentials.ca.string()},
                        {"dds.sec.access.governance", file + credentials.governance.string()},
                        {"dds.sec.access.permissions", file + credentials.permissions.string()}};
  append_plugin(properties, "auth", "dds_security_auth", "authentication");
  append_plugin(properties, "access", "dds_security_ac", "access_control");
  append_plugin(properties, "crypto", "dds_security_crypto", "crypto");
  return properties;
}

}  // namespace rds::bus::detail
