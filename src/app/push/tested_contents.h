// Which contents have passed the whole suite of their project: `kadans test` writes it, `kadans push --tested` asks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

class TestedContents {
 public:
  // A file of this user's for each project.
  explicit TestedContents(const std::filesystem::path& root);

  // The hash of what a push of each of these robots would bring now, "" for one that cannot be pushed.
  static std::vector<std::string> hashes_of(const std::vector<std::filesystem::path>& robots);

  bool passed(const std::string& hash) const;
  // Keeps them, the newest last, and forgets the oldest of many. Errors of writing are told by a push, not by a test.
  void keep(const std::vector<std::string>& hashes) const;

 private:
  std::vector<std::string> read() const;

  std::filesystem::path file_;
};

}  // namespace kadans
