// SPDX-License-Identifier: Apache-2.0
#include "common/bus/security.hpp"

#include <fstream>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/pem.h>

#include "common/bus/security_openssl.hpp"

namespace rds::bus {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::system_clock;

/// Why credentials are refused; it does not leave this file.
class Refused : public std::runtime_error {
 public:
  Refused(const fs::path& file, const std::string& reason)
      : std::runtime_error(file.string() + ": " + reason) {}
};

std::string read_file(const fs::path& file) {
  constexpr std::size_t kLargest = 1U << 20U;
  std::ifstream in(file, std::ios::binary);
  if (!in || !fs::is_regular_file(file)) throw Refused(file, "cannot be read");
  std::string text(kLargest + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kLargest) throw Refused(file, "is larger than 1 MiB");
  return text;
}

openssl::Certificate read_certificate(const fs::path& file) {
  const std::string text = read_file(file);
  openssl::Certificate certificate(
      PEM_read_bio_X509(openssl::reader_of(text).get(), nullptr, nullptr, nullptr));
  if (certificate == nullptr) throw Refused(file, "is damaged, expected a certificate in PEM form");
  return certificate;
}

openssl::Key read_key(const fs::path& file) {
  const std::string text = read_file(file);
  char no_password[] = "";  // or OpenSSL would ask on the terminal
  openssl::Key key(
      PEM_read_bio_PrivateKey(openssl::reader_of(text).get(), nullptr, nullptr, &no_password[0]));
  if (key == nullptr) throw Refused(file, "is damaged, expected a private key in PEM form without password");
  return key;
}

std::string date_of(const ASN1_TIME* time) {
  std::tm parts{};
  ASN1_TIME_to_tm(time, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

void check_validity(const fs::path& file, const X509* certificate, std::time_t now) {
  const ASN1_TIME* first = X509_get0_notBefore(certificate);
  const ASN1_TIME* last = X509_get0_notAfter(certificate);
  if (X509_cmp_time(last, &now) < 0)
    throw Refused(file, "has expired on " + date_of(last) + ", make new ones with: rds secure init --force");
  if (X509_cmp_time(first, &now) > 0)
    throw Refused(file, "is valid from " + date_of(first) + " on, and this machine's clock is before that");
}

/// @return the document's text.
std::string check_signature(const fs::path& file, X509* authority, std::time_t now) {
  const std::string text = read_file(file);
  BIO* raw_content = nullptr;
  const openssl::SignedDocument document(SMIME_read_PKCS7(openssl::reader_of(text).get(), &raw_content));
  const openssl::Bio content(raw_content);
  if (document == nullptr) throw Refused(file, "is damaged, expected a signed document (S/MIME)");
  const openssl::CertificateStore store(X509_STORE_new());
  X509_STORE_add_cert(store.get(), authority);
  X509_VERIFY_PARAM_set_time(X509_STORE_get0_param(store.get()), now);
  const openssl::Bio signed_text = openssl::empty_memory();
  if (PKCS7_verify(document.get(), nullptr, store.get(), content.get(), signed_text.get(), PKCS7_TEXT) != 1)
    throw Refused(file, fmt::format("is damaged or was signed by another authority than {}", kCaFile));
  return openssl::content_of(signed_text);
}

/// The name after "CN=" in "CN=tracker,O=RDS-SLAM".
std::string common_name_of(const std::string& subject) {
  const std::size_t start = subject.find("CN=");
  if (start == std::string::npos) return "";
  return subject.substr(start + 3, subject.find(',', start) - start - 3);
}

/// The subject of the first grant.
std::string granted_subject(const std::string& permissions) {
  const std::string tag = "<subject_name>";
  const std::size_t start = permissions.find(tag);
  if (start == std::string::npos) return "";
  const std::size_t text = start + tag.size();
  return permissions.substr(text, permissions.find('<', text) - text);
}

void check(const Credentials& files, std::time_t now) {
  const auto authority = read_certificate(files.ca);
  check_validity(files.ca, authority.get(), now);
  const auto certificate = read_certificate(files.certificate);
  if (X509_verify(certificate.get(), X509_get0_pubkey(authority.get())) != 1)
    throw Refused(files.certificate, fmt::format("was not signed by the authority of {}", files.ca.string()));
  check_validity(files.certificate, certificate.get(), now);
  const std::string subject = openssl::subject_of(certificate.get());
  if (common_name_of(subject) != files.identity)
    throw Refused(files.certificate,
                  fmt::format("is of '{}', expected '{}'", common_name_of(subject), files.identity));
  if (X509_check_private_key(certificate.get(), read_key(files.key).get()) != 1)
    throw Refused(files.key, fmt::format("is not the key of {}", kCertificateFile));
  check_signature(files.governance, authority.get(), now);
  const std::string granted = granted_subject(check_signature(files.permissions, authority.get(), now));
  if (granted != subject)
    throw Refused(files.permissions, fmt::format("are of '{}', expected '{}'", granted, subject));
}

}  // namespace

tl::expected<Credentials, std::string> read_credentials(const fs::path& folder, const std::string& identity,
                                                        Clock::time_point now) {
  std::error_code error;
  const fs::path base = fs::absolute(folder, error);
  if (error || !fs::is_directory(base, error))
    return tl::unexpected(
        fmt::format("{}: no such folder, expected one that rds secure init has made", folder.string()));
  const fs::path part = base / identity;
  if (!fs::is_directory(part, error))
    return tl::unexpected(fmt::format(
        "{}: no such folder, expected the certificate, key and permissions of {}", part.string(), identity));
  Credentials credentials{
      identity,        base / kCaFile,         base / kGovernanceFile, part / kCertificateFile,
      part / kKeyFile, part / kPermissionsFile};
  try {
    check(credentials, Clock::to_time_t(now));
  } catch (const Refused& refused) {
    ERR_clear_error();
    return tl::unexpected(std::string(refused.what()));
  }
  return credentials;
}

tl::expected<std::string, std::string> openssl::read_signed(const fs::path& document,
                                                            const fs::path& authority,
                                                            Clock::time_point now) {
  try {
    return check_signature(document, read_certificate(authority).get(), Clock::to_time_t(now));
  } catch (const Refused& refused) {
    ERR_clear_error();
    return tl::unexpected(std::string(refused.what()));
  }
}

}  // namespace rds::bus
