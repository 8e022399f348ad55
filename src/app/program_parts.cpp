#include "program_parts.h"

#include <cstdio>
#include <cstring>
#include <span>
#include <string>

#include <elf.h>
#include <link.h>

#include "kadans/signal/machine_name.h"
#include "version.h"

namespace kadans {
namespace {

std::string hexadecimal(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) {
    char two[3];
    std::snprintf(two, sizeof two, "%02x", byte);
    text += two;
  }
  return text;
}

// The build id in a segment of ELF notes; "" when there is none. A note is its head, its name and its content, each
// padded to four bytes.
std::string build_id(const unsigned char* notes, std::size_t size) {
  const auto padded = [](std::size_t length) { return (length + 3) / 4 * 4; };
  for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;) {
    ElfW(Nhdr) head{};
    std::memcpy(&head, notes + at, sizeof head);
    const std::size_t name = at + sizeof head, content = name + padded(head.n_namesz);
    if (content + head.n_descsz > size) break;
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && std::memcmp(notes + name, "GNU", 4) == 0)
      return hexadecimal(std::span(notes + content, head.n_descsz));
    at = content + padded(head.n_descsz);
  }
  return {};
}

int add_part(dl_phdr_info* info, std::size_t, void* target) {
  const std::string path = info->dlpi_name;
  const std::string file = path.substr(path.rfind('/') + 1);
  if (file.starts_with("linux-")) return 0;  // mapped by the kernel into every process
  std::string id;
  for (int i = 0; i < info->dlpi_phnum && id.empty(); ++i) {
    const ElfW(Phdr)& segment = info->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    id = build_id(reinterpret_cast<const unsigned char*>(info->dlpi_addr + segment.p_vaddr), segment.p_memsz);
  }
  (*static_cast<TextMap*>(target))[file.empty() ? "kadans" : file] = id;
  return 0;
}

}  // namespace

TextMap program_parts() {
  TextMap parts{{"version", version}, {"machine", machine_name()}};
  dl_iterate_phdr(add_part, &parts);
  return parts;
}

}  // namespace kadans
