// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "common/bus/security_openssl.hpp"

namespace rds::secure {

/// In which certificates and permissions hold.
struct Validity {
  std::chrono::system_clock::time_point from;
  std::chrono::system_clock::time_point until;
};

/// A certificate and its private key, PEM, and the certificate's subject as permissions name it.
struct Identity {
  std::string certificate;
  std::string key;
  std::string subject;
};

/// Signs certificates and documents with a key that it makes, keeps for itself and forgets: who comes into
/// the folder later cannot add an identity. Keys are of the curve P-256, which both vendors know. All members
/// throw std::runtime_error if OpenSSL fails.
class CertificateAuthority {
 public:
  explicit CertificateAuthority(const Validity& validity);

  [[nodiscard]] std::string certificate() const;  // PEM
  [[nodiscard]] Identity issue(const std::string& common_name) const;
  /// The text as S/MIME with a detached signature, as DDS Security wants its documents.
  [[nodiscard]] std::string sign(const std::string& text) const;

 private:
  [[nodiscard]] bus::openssl::Certificate make_certificate(const std::string& common_name, EVP_PKEY* key,
                                                           const char* basic_constraints,
                                                           const char* key_usage) const;

  Validity validity_;
  bus::openssl::Key key_;
  bus::openssl::Certificate certificate_;
};

}  // namespace rds::secure
