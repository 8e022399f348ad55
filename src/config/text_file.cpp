#include <fstream>
#include <system_error>

#include "kadans/config/json_value.h"

namespace kadans {

std::string read_text_file(const std::filesystem::path& file, std::size_t size_max_bytes) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) refuse(file.string(), {}, "there is no such file");
  if (!fs::is_regular_file(status)) refuse(file.string(), {}, "this is no file");
  const auto size = fs::file_size(file, error);
  if (error) refuse(file.string(), {}, "cannot be read: " + error.message());
  if (size > size_max_bytes) {
    refuse(file.string(), {}, "the file is larger than " + std::to_string(size_max_bytes >> 20U) + " MB");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  if (!stream || !stream.read(text.data(), static_cast<std::streamsize>(text.size()))) {
    refuse(file.string(), {}, "cannot be read");
  }
  return text;
}

}  // namespace kadans
