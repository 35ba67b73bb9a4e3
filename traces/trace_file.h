#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "model/command/commands.h"

// A trace on disk: FlatBuffers by the schema trace.fbs.
namespace splatscope::traces {

// Of the format. A file of a newer version is refused; older ones are read.
inline constexpr std::uint32_t kTraceVersion = 3;

inline constexpr int kMaxTextureEdge = 2048;  // texels: the limit of both machines of 2002

// The file appears whole or not at all. Throws UserError where the trace breaks a rule of check_trace or the
// place cannot be written.
void write_trace(const Trace& trace, const std::filesystem::path& path);

// The bytes of such a file, without a check of what they hold: traces of the same content have the same.
// Throws UserError, in `name`, where they are too many for a file.
std::vector<std::byte> trace_bytes(const Trace& trace, std::string_view name);

// Throws UserError where the file cannot be read, is damaged, newer than this program, or breaks a rule of
// check_trace. The memory taken is at most a small multiple of the file's size.
Trace read_trace(const std::filesystem::path& path);

// The same of a file's bytes, which must begin at an address that is a multiple of 8 (FlatBuffers).
Trace trace_of_bytes(std::span<const std::uint8_t> bytes, std::string_view file);

// Every rule that the model and the simulator rely on: sizes, indices, ranges, and programs that load.
// Throws UserError "file: what, expected what".
void check_trace(const Trace& trace, std::string_view file);

}  // namespace splatscope::traces
