#include "sim/units/vertex/issue_slots.h"

#include <algorithm>

#include "model/isa/opcode.h"
#include "model/isa/validate.h"
#include "model/vertex/vertex_program.h"

namespace splatscope::sim {
namespace {

using isa::Instruction;
using isa::Opcode;
using isa::RegisterFile;
using isa::Source;

constexpr ComponentMask kAddress = ComponentMask{1} << 48, kScratch = ComponentMask{1} << 52;

bool is_scalar(Opcode opcode) {
  switch (opcode) {
    case Opcode::rcp:
    case Opcode::rsq:
    case Opcode::expp:
    case Opcode::logp:
    case Opcode::lit:
      return true;
    default:
      return false;
  }
}

ComponentMask reads_of(const Instruction& instruction) {
  ComponentMask reads = 0;
  for (std::size_t i = 0; i < instruction.source_count; ++i) {
    const Source& source = instruction.sources[i];
    if (source.relative) reads |= kAddress;
    if (source.file != RegisterFile::temporary) continue;
    reads |= ComponentMask{isa::components_read(instruction, i)} << (4 * source.index);
  }
  return reads;
}

ComponentMask writes_of(const Instruction& instruction) {
  if (instruction.opcode == Opcode::nop) return 0;
  switch (instruction.destination.file) {
    case RegisterFile::temporary:
      return ComponentMask{instruction.destination.mask} << (4 * instruction.destination.index);
    case RegisterFile::address:
      return kAddress;
    default:
      return 0;
  }
}

// Bit 4n + c: component c of output n.
ComponentMask outputs_of(const Instruction& instruction) {
  if (instruction.opcode == Opcode::nop) return 0;
  const auto output = vertex::output_of(instruction.destination.file, instruction.destination.index);
  return output ? ComponentMask{instruction.destination.mask} << (4 * *output) : 0;
}

// An instruction of the expanded program, and the place of what it stands for in the program.
struct Part {
  Part(const Instruction& of, int at)
      : instruction(of), place(at), reads(reads_of(of)), writes(writes_of(of)), outputs(outputs_of(of)) {}

  Instruction instruction;
  int place;
  ComponentMask reads, writes, outputs;
};

// The rows of a matrix macro: a dot product each.
std::vector<Part> matrix_rows(const Instruction& instruction, int place, const isa::MatrixShape& shape) {
  std::vector<Part> rows;
  for (int row = 0; row < shape.rows; ++row) {
    Instruction dot = instruction;
    dot.opcode = shape.columns == 4 ? Opcode::dp4 : Opcode::dp3;
    dot.destination.mask = static_cast<std::uint8_t>(1u << row);
    dot.sources[1].index = static_cast<std::uint16_t>(instruction.sources[1].index + row);
    rows.emplace_back(dot, place);
  }
  return rows;
}

// exp, log and frc: a scalar instruction and a chain behind it, each on the result of the one before, of
// which the last writes an output. What the chip runs for them is not known; the length is Direct3D's.
std::vector<Part> chain(const Instruction& instruction, int place, int slots) {
  const Part whole(instruction, place);
  std::vector<Part> links(static_cast<std::size_t>(slots), whole);
  const ComponentMask between = whole.writes != 0 ? whole.writes : kScratch;
  for (Part& link : links) {
    const bool first = &link == &links.front(), last = &link == &links.back();
    link.instruction.opcode = !first                              ? Opcode::mul
                              : instruction.opcode == Opcode::log ? Opcode::logp
                                                                  : Opcode::expp;
    if (!first) {
      link.instruction.source_count = 0;  // a register between the links, no constant and no input
      link.reads = between;
    }
    if (!last) {
      link.writes = between;
      link.outputs = 0;
    }
  }
  return links;
}

std::vector<Part> expanded(const Instruction& instruction, int place, isa::Version version) {
  if (const auto shape = isa::matrix_shape(instruction.opcode); shape.rows != 0)
    return matrix_rows(instruction, place, shape);
  const isa::OpcodeInfo* info = isa::find_opcode(version, instruction.opcode);
  if (info && info->slots > 1) return chain(instruction, place, info->slots);
  return {{instruction, place}};
}

bool uses_third_port(Opcode opcode) {
  return opcode == Opcode::add || opcode == Opcode::sub || opcode == Opcode::mad;
}

// Whether the two read at most one register of a file (constants, inputs) together.
bool at_most_one(const Instruction& a, const Instruction& b, RegisterFile file) {
  const Source* seen = nullptr;
  for (const Instruction* instruction : {&a, &b}) {
    for (const Source& source : instruction->used_sources()) {
      if (source.file != file) continue;
      if (seen && (seen->index != source.index || seen->relative != source.relative)) return false;
      seen = &source;
    }
  }
  return true;
}

bool can_pair(const Part& first, const Part& second) {
  const Instruction &a = first.instruction, &b = second.instruction;
  if (a.opcode == Opcode::nop || b.opcode == Opcode::nop) return false;
  if (is_scalar(a.opcode) == is_scalar(b.opcode)) return false;
  const Instruction& vector = is_scalar(a.opcode) ? b : a;
  return !uses_third_port(vector.opcode) && (first.writes & (second.reads | second.writes)) == 0 &&
         at_most_one(a, b, RegisterFile::constant) && at_most_one(a, b, RegisterFile::input) &&
         (first.outputs == 0 || second.outputs == 0);
}

void add(IssueSlot& slot, const Part& part) {
  const Instruction& instruction = part.instruction;
  slot.instructions[slot.instructions[0] < 0 ? 0 : 1] = part.place;
  slot.reads |= part.reads;
  if (is_scalar(instruction.opcode)) {
    slot.has_scalar = true;
    slot.scalar_writes |= part.writes;
  } else {
    slot.has_vector = true;
    slot.vector_writes |= part.writes;
  }
}

// The order in which a driver gives the instructions of a program, which is a straight line: list scheduling,
// the instruction with the longest chain behind it first. It keeps to the registers that the program names.
class Reorder {
 public:
  Reorder(const std::vector<Part>& parts, const Machine::Vertex& spec)
      : parts_(parts), count_(parts.size()), pairing_(spec.pairing) {
    // Clocks in slots: the threads take turns, so a slot of one of them takes as many clocks as there are
    // threads.
    const auto in_slots = [&](int clocks) { return (clocks + spec.threads - 1) / spec.threads; };
    vector_distance_ = in_slots(spec.vector_latency);
    scalar_distance_ = in_slots(spec.scalar_latency);
    scalar_gap_ = spec.scalar_interval;
    nodes_.resize(count_);
    for (std::size_t i = count_; i-- > 0;) {
      each_bound(i, [&](Node& later, int apart) {
        nodes_[i].height = std::max(nodes_[i].height, later.height + apart);
        ++later.waits_for;
      });
    }
  }

  std::vector<IssueSlot> run() {
    std::vector<IssueSlot> slots;
    std::size_t left = count_;
    for (; left != 0; ++now_) {
      const std::size_t first = best(count_);
      if (first == count_) continue;  // here the unit will wait
      IssueSlot slot;
      place(first, slot);
      --left;
      const std::size_t second = pairing_ ? best(first) : count_;
      if (second != count_) {
        place(second, slot);
        --left;
      }
      slots.push_back(slot);
    }
    return slots;
  }

 private:
  struct Node {
    int height = 0;     // slots to the end of the longest chain behind it
    int waits_for = 0;  // that are not placed and have to stand before it
    int earliest = 0;   // slot, by those that are placed
    bool placed = false;
  };

  // Slots that `later` must stand behind `earlier`; -1: they are independent.
  int distance(std::size_t earlier, std::size_t later) const {
    const Part& a = parts_[earlier];
    const Part& b = parts_[later];
    if ((a.writes & (b.reads | b.writes)) != 0)
      return is_scalar(a.instruction.opcode) ? scalar_distance_ : vector_distance_;
    if ((a.outputs & b.outputs) != 0) return 1;
    return (a.reads & b.writes) != 0 ? 0 : -1;
  }

  // function(node, slots) for each that must stand so many slots behind `earlier`.
  template <typename Function>
  void each_bound(std::size_t earlier, Function function) {
    for (std::size_t later = earlier + 1; later < count_; ++later)
      if (const int apart = distance(earlier, later); apart >= 0) function(nodes_[later], apart);
  }

  bool is_ready(std::size_t index) const {
    const Node& node = nodes_[index];
    return !node.placed && node.waits_for == 0 && node.earliest <= now_ &&
           !(is_scalar(parts_[index].instruction.opcode) && now_ < scalar_free_);
  }

  // The ready instruction with the longest chain behind it, of those that pair with `partner` (count_: any at
  // all). count_: there is none.
  std::size_t best(std::size_t partner) const {
    std::size_t chosen = count_;
    for (std::size_t i = 0; i < count_; ++i) {
      if (!is_ready(i)) continue;
      if (partner != count_ && !can_pair(parts_[std::min(i, partner)], parts_[std::max(i, partner)]))
        continue;
      if (chosen == count_ || nodes_[i].height > nodes_[chosen].height) chosen = i;
    }
    return chosen;
  }

  void place(std::size_t index, IssueSlot& slot) {
    nodes_[index].placed = true;
    each_bound(index, [&](Node& later, int apart) {
      --later.waits_for;
      later.earliest = std::max(later.earliest, now_ + apart);
    });
    if (is_scalar(parts_[index].instruction.opcode)) scalar_free_ = now_ + scalar_gap_;
    add(slot, parts_[index]);
  }

  const std::vector<Part>& parts_;
  std::size_t count_;
  bool pairing_;
  int vector_distance_ = 1, scalar_distance_ = 1, scalar_gap_ = 1;
  std::vector<Node> nodes_;
  int now_ = 0;
  int scalar_free_ = 0;
};

std::vector<IssueSlot> in_program_order(const std::vector<Part>& parts, bool pairing) {
  std::vector<IssueSlot> slots;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    IssueSlot& slot = slots.emplace_back();
    add(slot, parts[i]);
    if (pairing && i + 1 < parts.size() && can_pair(parts[i], parts[i + 1])) add(slot, parts[++i]);
  }
  return slots;
}

}  // namespace

std::vector<IssueSlot> issue_slots(const isa::Program& program, const Machine::Vertex& spec) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < program.instructions.size(); ++i) {
    for (const Part& part : expanded(program.instructions[i], static_cast<int>(i), program.version))
      parts.push_back(part);
  }
  return spec.driver_reorders ? Reorder(parts, spec).run() : in_program_order(parts, spec.pairing);
}

}  // namespace splatscope::sim
