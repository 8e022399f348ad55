#include "tested_contents.h"

#include <algorithm>
#include <fstream>

#include "app/line_editor.h"
#include "delivery.h"
#include "kadans/signal/content_hash.h"
#include "kadans/signal/input_error.h"
#include "signal/durable_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept_max = 1000;

std::string hash_of_name(const fs::path& root) {
  ContentHash hash;
  hash.add(fs::absolute(root).lexically_normal().string());
  return hash.hex();
}

}  // namespace

TestedContents::TestedContents(const fs::path& root) : file_(state_file("tested-" + hash_of_name(root))) {}

std::vector<std::string> TestedContents::hashes_of(const std::vector<fs::path>& robots) {
  std::vector<std::string> hashes;
  for (const fs::path& robot : robots) {
    try {
      hashes.push_back(gather_delivery(robot).hash());
    } catch (const InputError&) {
      hashes.emplace_back();
    }
  }
  return hashes;
}

std::vector<std::string> TestedContents::read() const {
  std::vector<std::string> hashes;
  std::ifstream stream(file_);
  for (std::string line; std::getline(stream, line);) hashes.push_back(line);
  return hashes;
}

bool TestedContents::passed(const std::string& hash) const { return std::ranges::count(read(), hash) != 0; }

void TestedContents::keep(const std::vector<std::string>& hashes) const {
  if (file_.empty()) return;
  std::vector<std::string> all = read();
  for (const std::string& hash : hashes) {
    std::erase(all, hash);
    if (!hash.empty()) all.push_back(hash);
  }
  std::string text;
  for (std::size_t i = all.size() > kept_max ? all.size() - kept_max : 0; i < all.size(); ++i) text += all[i] + "\n";
  try {
    write_durably(file_, text);
  } catch (const InputError&) {
  }
}

}  // namespace kadans
