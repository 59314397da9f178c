// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace rds::viewer {

/// A file of the page, which is part of the program.
struct PageFile {
  std::string_view content_type;
  std::string_view bytes;
};

/// @param path  "/app.js"; "/" is the page itself. @return nullopt for all that is no file of the page.
std::optional<PageFile> find_page_file(std::string_view path);

}  // namespace rds::viewer
