// SPDX-License-Identifier: Apache-2.0
#include "tools/rds/secure/certificate_authority.hpp"

#include <stdexcept>

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/rand.h>

namespace rds::secure {
namespace openssl = bus::openssl;
namespace {

constexpr const char* kOrganisation = "RDS-SLAM";

void require(bool succeeded, const std::string& what) {
  if (succeeded) return;
  char reason[256] = "";
  ERR_error_string_n(ERR_get_error(), &reason[0], sizeof reason);
  throw std::runtime_error("OpenSSL cannot " + what + ": " + &reason[0]);
}

openssl::Key make_key() {
  openssl::Key key(EVP_EC_gen("P-256"));
  require(key != nullptr, "make a key");
  return key;
}

std::string pem(X509* certificate) {
  const openssl::Bio memory = openssl::empty_memory();
  require(PEM_write_bio_X509(memory.get(), certificate) == 1, "write a certificate");
  return openssl::content_of(memory);
}

std::string pem(EVP_PKEY* key) {
  const openssl::Bio memory = openssl::empty_memory();
  require(PEM_write_bio_PrivateKey(memory.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
          "write a private key");
  return openssl::content_of(memory);
}

void set_serial_number(X509* certificate) {
  std::uint64_t number = 0;
  require(RAND_bytes(reinterpret_cast<unsigned char*>(&number), sizeof number) == 1, "make a serial number");
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate), number >> 1U);
}

void set_name(X509_NAME* name, const std::string& common_name) {
  const auto add = [name](const char* field, const std::string& value) {
    require(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8,
                                       reinterpret_cast<const unsigned char*>(value.data()),
                                       static_cast<int>(value.size()), -1, 0) == 1,
            "name a certificate");
  };
  add("O", kOrganisation);
  add("CN", common_name);
}

void set_validity(X509* certificate, const Validity& validity) {
  std::time_t from = std::chrono::system_clock::to_time_t(validity.from);
  std::time_t until = std::chrono::system_clock::to_time_t(validity.until);
  require(X509_time_adj_ex(X509_getm_notBefore(certificate), 0, 0, &from) != nullptr &&
              X509_time_adj_ex(X509_getm_notAfter(certificate), 0, 0, &until) != nullptr,
          "date a certificate");
}

void add_extension(X509* certificate, int nid, const char* value) {
  const openssl::Extension extension(X509V3_EXT_conf_nid(nullptr, nullptr, nid, value));
  require(extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1,
          "extend a certificate");
}

}  // namespace

CertificateAuthority::CertificateAuthority(const Validity& validity)
    : validity_(validity),
      key_(make_key()),
      certificate_(make_certificate("authority", key_.get(), "critical,CA:TRUE",
                                    "critical,digitalSignature,keyCertSign,cRLSign")) {}

openssl::Certificate CertificateAuthority::make_certificate(const std::string& common_name, EVP_PKEY* key,
                                                            const char* basic_constraints,
                                                            const char* key_usage) const {
  openssl::Certificate certificate(X509_new());
  require(certificate != nullptr && X509_set_version(certificate.get(), X509_VERSION_3) == 1,
          "make a certificate");
  set_serial_number(certificate.get());
  set_name(X509_get_subject_name(certificate.get()), common_name);
  const X509* issuer = certificate_ == nullptr ? certificate.get() : certificate_.get();
  require(X509_set_issuer_name(certificate.get(), X509_get_subject_name(issuer)) == 1, "name an issuer");
  set_validity(certificate.get(), validity_);
  require(X509_set_pubkey(certificate.get(), key) == 1, "certify a key");
  add_extension(certificate.get(), NID_basic_constraints, basic_constraints);
  add_extension(certificate.get(), NID_key_usage, key_usage);
  require(X509_sign(certificate.get(), key_.get(), EVP_sha256()) > 0, "sign a certificate");
  return certificate;
}

std::string CertificateAuthority::certificate() const {
  return pem(certificate_.get());
}

Identity CertificateAuthority::issue(const std::string& common_name) const {
  const openssl::Key key = make_key();
  const auto certificate =
      make_certificate(common_name, key.get(), "critical,CA:FALSE", "critical,digitalSignature");
  return {pem(certificate.get()), pem(key.get()), openssl::subject_of(certificate.get())};
}

std::string CertificateAuthority::sign(const std::string& text) const {
  constexpr int kFlags = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const openssl::Bio content = openssl::reader_of(text);
  const openssl::SignedDocument document(
      PKCS7_sign(certificate_.get(), key_.get(), nullptr, content.get(), kFlags));
  const openssl::Bio memory = openssl::empty_memory();
  require(document != nullptr && SMIME_write_PKCS7(memory.get(), document.get(), content.get(), kFlags) == 1,
          "sign a document");
  return openssl::content_of(memory);
}

}  // namespace rds::secure
