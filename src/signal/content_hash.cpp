#include "kadans/signal/content_hash.h"

#include <algorithm>
#include <vector>

#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t file_max_bytes = std::size_t{1} << 30U;  // programs and their libraries, too

namespace fs = std::filesystem;

}  // namespace

void ContentHash::add(std::string_view text) noexcept {
  hash_.add(text.size());
  // Eight bytes at a time, in an order of our own choice.
  for (std::size_t i = 0; i < text.size(); i += 8) {
    std::uint64_t word = 0;
    for (std::size_t k = i; k < std::min(i + 8, text.size()); ++k)
      word = word << 8U | static_cast<unsigned char>(text[k]);
    hash_.add(word);
  }
}

void ContentHash::add_file(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    add("no such file");
    return;
  }
  add(read_input_file(file, file_max_bytes));
}

void ContentHash::add_folder(const fs::path& folder, std::string_view ending, const fs::path& leave_out) {
  std::vector<fs::path> files;
  std::error_code error;
  if (!fs::exists(folder, error) && !error) return add("no such folder");
  for (fs::recursive_directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    if (!leave_out.empty() && i->is_directory(error) && fs::equivalent(i->path(), leave_out, error))
      i.disable_recursion_pending();
    if (i->is_regular_file(error) && i->path().filename().string().ends_with(ending)) files.push_back(i->path());
  }
  if (error) refuse(folder, "cannot be read: " + error.message());
  std::ranges::sort(files);
  for (const fs::path& file : files) {
    add(file.lexically_relative(folder).generic_string());
    add_file(file);
  }
}

std::string ContentHash::hex() const { return hash_text(value()); }

}  // namespace kadans
