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

constexpr std::size_t passed_max = 1000;

fs::path passed_file(const fs::path& root) {
  ContentHash name;
  name.add(fs::absolute(root).lexically_normal().string());
  return state_file("tested-" + name.hex());
}

}  // namespace

std::vector<std::string> delivery_hashes(const std::vector<fs::path>& robots) {
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

bool has_passed(const fs::path& root, const std::string& hash) {
  return std::ranges::count(kept_lines(passed_file(root)), hash) != 0;
}

void keep_passed(const fs::path& root, const std::vector<std::string>& hashes) {
  const fs::path file = passed_file(root);
  std::vector<std::string> all = kept_lines(file);
  for (const std::string& hash : hashes) {
    std::erase(all, hash);
    if (!hash.empty()) all.push_back(hash);
  }
  if (all.size() > passed_max) all.erase(all.begin(), all.end() - passed_max);
  keep_lines(file, all);
}

std::vector<std::string> kept_lines(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void keep_lines(const fs::path& file, const std::vector<std::string>& lines) {
  if (file.empty()) return;
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  try {
    write_durably(file, text);
  } catch (const InputError&) {
  }
}

}  // namespace kadans
