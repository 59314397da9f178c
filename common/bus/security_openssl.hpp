// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <tl/expected.hpp>

/// OpenSSL's objects with an owner, for those who make and those who check credentials.
namespace rds::bus::openssl {

template <auto free_function>
struct Free {
  template <class T>
  void operator()(T* object) const {
    free_function(object);
  }
};

using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using CertificateStore = std::unique_ptr<X509_STORE, Free<X509_STORE_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, Free<X509_EXTENSION_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using SignedDocument = std::unique_ptr<PKCS7, Free<PKCS7_free>>;

/// A memory to read `text` from; `text` must outlive it.
inline Bio reader_of(std::string_view text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

inline Bio empty_memory() {
  return Bio(BIO_new(BIO_s_mem()));
}

/// What was written to a memory.
inline std::string content_of(const Bio& memory) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

/// The certificate's subject as RFC 2253 writes it, as the permissions name it: "CN=tracker,O=RDS-SLAM".
inline std::string subject_of(const X509* certificate) {
  const Bio memory = empty_memory();
  X509_NAME_print_ex(memory.get(), X509_get_subject_name(certificate), 0, XN_FLAG_RFC2253);
  return content_of(memory);
}

/// The text of a signed document (S/MIME).
///
/// @param authority  file of the certificate, in PEM form, that must have signed it.
/// @return or one sentence that names the file.
tl::expected<std::string, std::string> read_signed(const std::filesystem::path& document,
                                                   const std::filesystem::path& authority,
                                                   std::chrono::system_clock::time_point now);

}  // namespace rds::bus::openssl
