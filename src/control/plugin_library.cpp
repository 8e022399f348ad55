#include "plugin_library.h"

#include <algorithm>
#include <cfenv>
#include <cstring>
#include <fstream>
#include <span>
#include <stdexcept>
#include <system_error>

#include <dlfcn.h>
#include <link.h>

#include "kadans/control/plugin.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t types_max = 64;
constexpr std::size_t name_max = 64;

[[noreturn]] void refuse_plugin(const fs::path& file, const std::string& why) {
  throw std::invalid_argument("plug-in " + file.string() + ": " + why);
}

template <typename T>
bool read_at(std::ifstream& stream, std::uint64_t offset, T& value) {
  stream.seekg(static_cast<std::streamoff>(offset));
  return static_cast<bool>(stream.read(reinterpret_cast<char*>(&value), sizeof value));
}

// The loader maps what the library's headers promise; where the file ends earlier the process would die of SIGBUS. What
// else is wrong with a file the loader says itself.
void refuse_cut_off(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  const std::uint64_t bytes = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  ElfW(Ehdr) head{};
  if (!read_at(stream, 0, head) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0) return;
  if (head.e_ident[EI_CLASS] != (sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32)) return;
  for (std::uint64_t i = 0; i < head.e_phnum; ++i) {
    ElfW(Phdr) segment{};
    const bool there = read_at(stream, head.e_phoff + i * head.e_phentsize, segment);
    const bool whole = there && segment.p_offset <= bytes && segment.p_filesz <= bytes - segment.p_offset;
    if (!there || (segment.p_type == PT_LOAD && !whole))
      refuse_plugin(file, "is cut off after " + std::to_string(bytes) + " bytes: copy or build it again");
  }
}

const PluginDescriptor& descriptor_in(const fs::path& file) {
  refuse_cut_off(file);
  std::fenv_t rounding;
  (void)std::fegetenv(&rounding);  // a library built with -ffast-math sets the processor to flush small numbers to 0
  // Links are resolved, so that what stands beside a link is not taken for what stands beside the library.
  std::error_code error;
  const fs::path whole = fs::canonical(file, error);
  void* const library = dlopen((error ? file : whole).c_str(), RTLD_NOW | RTLD_LOCAL);
  (void)std::fesetenv(&rounding);
  if (library == nullptr) refuse_plugin(file, std::string("cannot be loaded: ") + dlerror());
  const void* const symbol = dlsym(library, "kadans_plugin");
  if (symbol == nullptr) refuse_plugin(file, "exports no kadans_plugin, so it is no plug-in of Kadans");
  return *static_cast<const PluginDescriptor*>(symbol);
}

std::vector<std::string_view> parts_of(std::string_view build) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = build.find(", ");
    parts.push_back(build.substr(0, comma));
    if (comma == std::string_view::npos) return parts;
    build.remove_prefix(comma + 2);
  }
}

// What of a build is not so in the other.
std::string differing(std::string_view build, std::string_view other) {
  const std::vector<std::string_view> own = parts_of(build), others = parts_of(other);
  std::string text;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own.size() == others.size() && own[i] == others[i]) continue;
    text += (text.empty() ? "" : ", ") + std::string(own[i]);
  }
  return text;
}

void check_build(const fs::path& file, const PluginDescriptor& plugin) {
  constexpr PluginDescriptor own;
  constexpr const char* remedy =
      ": build it again with the headers and libraries of this program's package, its compiler and its flags";
  if (std::memcmp(plugin.magic, own.magic, sizeof own.magic) != 0)
    refuse_plugin(file,
                  "exports a kadans_plugin of another kind than this program's, " KADANS_SDK + std::string(remedy));
  const std::string_view build(plugin.build, strnlen(plugin.build, sizeof plugin.build)), here(own.build);
  if (build != here) {
    refuse_plugin(
        file, "was built with " + differing(build, here) + ", this program with " + differing(here, build) + remedy);
  }
  if (plugin.size != own.size) {
    refuse_plugin(file, "says that its descriptor has " + std::to_string(plugin.size) + " bytes, this program's has " +
                            std::to_string(own.size) + remedy);
  }
}

bool right_name(std::string_view name) {
  return !name.empty() && name.size() <= name_max &&
         std::ranges::all_of(name, [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

std::string name_of(const fs::path& file, const PluginType& type) {
  if (type.make_plant == nullptr) return type.name == nullptr ? "" : type.name;
  const std::unique_ptr<PlantType> made = type.make_plant();
  if (!made) refuse_plugin(file, "makes no type of plant where it promises one");
  return std::string(made->name());
}

}  // namespace

void load_plugin(const fs::path& file, ControlObjectTypes& types, std::vector<MakePlantType>& plants) {
  const PluginDescriptor& plugin = descriptor_in(file);
  check_build(file, plugin);
  if (plugin.types == nullptr || plugin.count < 1 || plugin.count > types_max) {
    refuse_plugin(
        file, "brings " + std::to_string(plugin.count) + " types, 1.." + std::to_string(types_max) + " are possible");
  }
  for (const PluginType& type : std::span(plugin.types, plugin.count)) {
    const std::string name = name_of(file, type);
    if (!right_name(name)) refuse_plugin(file, "names a type with other than 1..64 of a-z, 0-9 and _");
    if (type.make_plant != nullptr) {
      plants.push_back(type.make_plant);
      continue;
    }
    try {
      types.add(name, type.make_object, "the plug-in");
    } catch (const std::invalid_argument& error) {
      refuse_plugin(file, error.what());
    }
  }
}

}  // namespace kadans
