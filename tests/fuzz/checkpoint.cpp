// Checkpoints that somebody sends, as far as their files lie in a folder: what they bring is unpacked into a folder of
// its own that is gone afterwards, and nothing else in the world is made, changed or taken away.
//
// An input is a file, or, if it does not begin as one, files to make a checkpoint of, a line each: "PATH<tab>TEXT", or
// "!PATH" for a plug-in that is known as the one that lies here.
#include "app/sim/checkpoint.h"

#include <map>

#include "app/sim/input_files.h"
#include "fuzz_input.h"
#include "telemetry/mcap/mcap_format.h"
#include "temporary_folder.h"

namespace {

using namespace kadans;
namespace fs = std::filesystem;
using fuzz::require;

constexpr const char* plugin = "not a library, but one by its hash";

// All that lies in a folder: what a file or a link holds, by its name.
using Contents = std::map<std::string, std::string>;

std::string content_of(const fs::directory_entry& entry) {
  if (entry.is_symlink()) return "-> " + fs::read_symlink(entry.path()).string();
  if (!entry.is_regular_file()) return "";
  std::ifstream in(entry.path(), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Contents contents(const fs::path& folder) {
  Contents all;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    all[entry.path().lexically_relative(folder).string()] = content_of(entry);
  return all;
}

// outside/home is the project around the working directory, outside/tmp takes what is unpacked.
struct Outside {
  test::TemporaryFolder folder;
  fs::path unpacked = folder.path() / "tmp";
  Contents before;

  Outside() {
    folder.write("home/models/own.so", plugin);
    folder.write("home/scripts/x.sh", "mine");
    folder.write("home/config/robot.json", "{}");
    folder.write("victim", "mine");
    fs::create_directories(unpacked);
    fs::create_directory_symlink(folder.path() / "home", folder.path() / "link");
    setenv("TMPDIR", unpacked.c_str(), 1);
    before = contents(folder.path());
  }
  // But for the one folder, everything is as it was.
  bool untouched(const fs::path& own) const {
    Contents now = contents(folder.path());
    const std::string name = own.lexically_relative(folder.path()).string();
    if (!own.empty())
      std::erase_if(now, [&](const auto& entry) { return (entry.first + "/").starts_with(name + "/"); });
    return now == before;
  }
};

// The working directory is the project in it, for a while.
class Home {
 public:
  explicit Home(const Outside& outside) { fs::current_path(outside.folder.path() / "home"); }
  ~Home() { fs::current_path(before_); }
  Home(const Home&) = delete;
  Home& operator=(const Home&) = delete;

 private:
  fs::path before_ = fs::current_path();
};

std::string made_of(fuzz::FuzzInput input) {
  RunInputs inputs;
  for (int i = 0; !input.empty() && i < 20; ++i) {
    const std::string line(input.line());
    const std::size_t tab = line.find('\t');
    if (line.starts_with('!')) {
      inputs.files.push_back({line.substr(1), content_hash(plugin), std::nullopt});
    } else if (tab == std::string::npos) {
      inputs.run["scenario_input"] = line;
    } else {
      const std::string text = line.substr(tab + 1);
      inputs.files.push_back({line.substr(0, tab), content_hash(text), text});
    }
  }
  const fuzz::MemoryFile file;
  write_checkpoint({.inputs = inputs, .at = {.ticks = 7, .time_ns = 7'000'000, .state_hash = 9}, .trail = {}},
                   file.path());
  return read_input_file(file.path());
}

void unpack(const Outside& outside, const std::string& file) {
  const Checkpoint checkpoint = read_checkpoint(file);
  const UnpackedInputs unpacked(checkpoint.inputs, file, false);
  fs::path own = unpacked.scenario();
  while (own.parent_path() != outside.unpacked && own.has_relative_path()) own = own.parent_path();
  require(own.parent_path() == outside.unpacked, "a scenario is unpacked into a folder of its own");
  require(fs::is_regular_file(unpacked.scenario()), "a scenario is there");
  require((fs::status(own).permissions() & fs::perms::others_all) == fs::perms::none, "others do not see it");
  require(outside.untouched(own), "nothing is written elsewhere");
  for (const auto& entry : fs::recursive_directory_iterator(own)) {
    const bool plug_in = entry.is_symlink() && fs::read_symlink(entry.path()) == fs::current_path() / "models/own.so";
    require(!entry.is_symlink() || plug_in, "no link is unpacked but to a plug-in that lies here");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Outside outside;
  std::string content(reinterpret_cast<const char*>(data), size);
  if (!content.starts_with(mcap_magic.substr(0, 4))) content = made_of({data, size});
  const fuzz::MemoryFile file(content);
  try {
    const Home home(outside);
    unpack(outside, file.path());
  } catch (const InputError&) {  // what cannot be unpacked is told
  }
  require(outside.untouched({}), "all that was unpacked is gone");
  return 0;
}
