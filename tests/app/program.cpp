#include "program.h"

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans::program {

namespace fs = std::filesystem;

namespace {

// `how`: "exec " puts the program in the shell's place, so that signals reach it.
std::string command_in(const fs::path& where, const std::string& how) {
  return "cd '" + where.string() + "' && XDG_STATE_HOME=\"$PWD/state\" XDG_RUNTIME_DIR=\"$PWD/session\" " + how +
         "'" KADANS_BINARY_DIR "/kadans' </dev/null ";
}

int exit_code(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

}  // namespace

// The address of a socket can be had once; the system takes it back with the process.
int own_dds_domain() {
  constexpr int domains = 230;
  const int claim = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  for (int i = 0; i < domains; ++i) {
    const int domain = 1 + (getpid() + i) % domains;
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::snprintf(name.sun_path + 1, sizeof name.sun_path - 1, "kadans-tests-dds-%d", domain);
    if (bind(claim, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0) return domain;
  }
  throw std::runtime_error("no DDS domain is free");
}

Outcome run(const std::string& arguments, const fs::path& where) {
  const fs::path out = where / "stdout.txt", err = where / "stderr.txt";
  const std::string command = command_in(where, "") + arguments + " >'" + out.string() + "' 2>'" + err.string() + "'";
  const int status = std::system(command.c_str());  // NOLINT: the shell is the point
  return {exit_code(status), read(out), read(err)};
}

Running::Running(const fs::path& where, const std::string& arguments) {
  std::array<int, 2> ends{};
  REQUIRE(pipe2(ends.data(), O_CLOEXEC) == 0);
  const std::string command = command_in(where, "exec ") + arguments;
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  close(ends[1]);
  output_ = fdopen(ends[0], "r");
}

Running::~Running() {
  if (!ended_) {
    signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  std::fclose(output_);
}

bool Running::says(const std::string& text) {
  std::array<char, 4096> line{};
  while (std::fgets(line.data(), line.size(), output_) != nullptr) {
    heard_ += line.data();
    if (has(line.data(), text)) return true;
  }
  return false;
}

int Running::end() {
  (void)says("\n\n no line is like this");
  int status = 0;
  waitpid(pid_, &status, 0);
  ended_ = true;
  return exit_code(status);
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

std::size_t results_in(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    count += entry.path().parent_path().filename() == "cases" ? 1 : 0;
  return count;
}

std::vector<fs::path> flights_in(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (has(entry.path().filename().string(), "flight")) found.push_back(entry.path());
  }
  return found;
}

void check_damaged(const fs::path& record) {
  const std::string whole = read(record);
  for (std::size_t i = 1; i < 12; ++i) {
    std::string damaged = whole;
    damaged[i * whole.size() / 12] = static_cast<char>(~damaged[i * whole.size() / 12]);
    write(record.parent_path() / "damaged.mcap", damaged);
    const Outcome outcome = run("replay damaged.mcap", record.parent_path());
    CAPTURE(i);
    CHECK(outcome.exit_code <= 2);
    CHECK_MESSAGE(has(outcome.out + outcome.err, "damaged.mcap"), (outcome.out + outcome.err));
  }
}

std::vector<std::vector<double>> rows_of_table(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    auto& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
  }
  return rows;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n') + 1;
  const std::size_t begin = text.rfind('\n', end - 1) + 1;
  return text.substr(begin, end - begin);
}

}  // namespace kadans::program
