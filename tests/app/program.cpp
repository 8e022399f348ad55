#include "program.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <sys/wait.h>
#include <unistd.h>

namespace kadans::program {

namespace fs = std::filesystem;

Outcome run(const std::string& arguments, const fs::path& where) {
  const fs::path out = where / "stdout.txt", err = where / "stderr.txt";
  const std::string command = "cd '" + where.string() +
                              "' && XDG_STATE_HOME=\"$PWD/state\" XDG_RUNTIME_DIR=\"$PWD/session\" '" KADANS_BINARY_DIR
                              "/kadans' </dev/null " +
                              arguments + " >'" + out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());  // NOLINT: the shell is the point
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, read(out), read(err)};
}

namespace {

// The folders of this process: ctest runs several cases of one program at once, each in a process of its own. They lie
// in a project that holds nothing, so that no file of this one is found above them.
struct OwnFolders {
  fs::path root = fs::path(KADANS_BINARY_DIR) / "tests" / "folders" / std::to_string(getpid());
  OwnFolders() {
    for (const char* part : {"config", "behaviors"}) fs::create_directories(root / part);
  }
  ~OwnFolders() {
    std::error_code ignored;
    fs::remove_all(root, ignored);
  }
  OwnFolders(const OwnFolders&) = delete;
  OwnFolders& operator=(const OwnFolders&) = delete;
};

}  // namespace

fs::path fresh_folder(const std::string& name) {
  static const OwnFolders own;
  const fs::path folder = own.root / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

fs::path project_copy(const std::string& name) {
  const fs::path folder = fresh_folder(name);
  for (const char* part : {"config", "models", "behaviors"}) {
    fs::copy(fs::path(KADANS_SOURCE_DIR) / part, folder / part, fs::copy_options::recursive);
  }
  return folder;
}

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

bool edit(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = read(file);
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return false;
  write(file, text.replace(at, from.size(), to));
  return true;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n') + 1;
  const std::size_t begin = text.rfind('\n', end - 1) + 1;
  return text.substr(begin, end - begin);
}

}  // namespace kadans::program
