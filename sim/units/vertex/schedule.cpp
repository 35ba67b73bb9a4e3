#include "sim/units/vertex/schedule.h"

#include <algorithm>
#include <bit>

#include "model/isa/opcode.h"

namespace splatscope::sim {
namespace {

using isa::Instruction;
using isa::Opcode;
using isa::RegisterFile;
using isa::Source;

constexpr ComponentMask kAddress = ComponentMask{1} << 48;

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

// The rows of a matrix macro: a dot product each.
std::vector<Instruction> matrix_rows(const Instruction& instruction, const isa::MatrixShape& shape) {
  std::vector<Instruction> rows;
  for (int row = 0; row < shape.rows; ++row) {
    Instruction dot = instruction;
    dot.opcode = shape.columns == 4 ? Opcode::dp4 : Opcode::dp3;
    dot.destination.mask = static_cast<std::uint8_t>(1u << row);
    dot.sources[1].index = static_cast<std::uint8_t>(instruction.sources[1].index + row);
    rows.push_back(dot);
  }
  return rows;
}

// exp, log and frc: a scalar instruction and a chain behind it, each on the result of the one before. What
// the chip runs for them is not known; the length is Direct3D's.
std::vector<Instruction> chain(const Instruction& instruction, int slots) {
  Instruction link = instruction;
  link.opcode = instruction.opcode == Opcode::log ? Opcode::logp : Opcode::expp;
  std::vector<Instruction> links{link};
  link.opcode = Opcode::mul;
  link.source_count = 1;
  link.sources[0] = {};
  link.sources[0].file = instruction.destination.file;
  link.sources[0].index = instruction.destination.index;
  links.resize(static_cast<std::size_t>(slots), link);
  return links;
}

std::vector<Instruction> expanded(const Instruction& instruction, isa::Version version) {
  if (const auto shape = isa::matrix_shape(instruction.opcode); shape.rows != 0)
    return matrix_rows(instruction, shape);
  const isa::OpcodeInfo* info = isa::find_opcode(version, instruction.opcode);
  if (info && info->slots > 1) return chain(instruction, info->slots);
  return {instruction};
}

// Components of the source operand (before its swizzle) that source `index` of the instruction uses.
unsigned used_components(const Instruction& instruction, int index) {
  switch (instruction.opcode) {
    case Opcode::dp3:
      return 0x7;
    case Opcode::dp4:
      return 0xf;
    case Opcode::lit:
      return 0xb;  // x, y, w
    case Opcode::dst:
      return index == 0 ? 0x6 : 0xa;  // y, z and y, w
    case Opcode::rcp:
    case Opcode::rsq:
    case Opcode::expp:
    case Opcode::logp:
      return 0x8;  // a replicated component: the last of the swizzle is any of them
    default:
      return instruction.destination.mask;
  }
}

ComponentMask reads_of(const Instruction& instruction) {
  ComponentMask reads = 0;
  for (int i = 0; i < instruction.source_count; ++i) {
    const Source& source = instruction.sources[static_cast<std::size_t>(i)];
    if (source.relative) reads |= kAddress;
    if (source.file != RegisterFile::temporary) continue;
    const unsigned used = used_components(instruction, i);
    for (unsigned component = 0; component < 4; ++component) {
      if (used >> component & 1) reads |= ComponentMask{1} << (4 * source.index + source.swizzle[component]);
    }
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

bool writes_output(const Instruction& instruction) {
  const RegisterFile file = instruction.destination.file;
  return instruction.opcode != Opcode::nop && file != RegisterFile::temporary &&
         file != RegisterFile::address;
}

bool uses_third_port(Opcode opcode) {
  return opcode == Opcode::add || opcode == Opcode::sub || opcode == Opcode::mad;
}

// Whether the two read at most one register of a file (constants, inputs) together.
bool at_most_one(const Instruction& a, const Instruction& b, RegisterFile file) {
  const Source* seen = nullptr;
  for (const Instruction* instruction : {&a, &b}) {
    for (int i = 0; i < instruction->source_count; ++i) {
      const Source& source = instruction->sources[static_cast<std::size_t>(i)];
      if (source.file != file) continue;
      if (seen && (seen->index != source.index || seen->relative != source.relative)) return false;
      seen = &source;
    }
  }
  return true;
}

bool can_pair(const Instruction& first, const Instruction& second) {
  if (first.opcode == Opcode::nop || second.opcode == Opcode::nop) return false;
  if (is_scalar(first.opcode) == is_scalar(second.opcode)) return false;
  const Instruction& vector = is_scalar(first.opcode) ? second : first;
  return !uses_third_port(vector.opcode) &&
         (writes_of(first) & (reads_of(second) | writes_of(second))) == 0 &&
         at_most_one(first, second, RegisterFile::constant) &&
         at_most_one(first, second, RegisterFile::input) && !(writes_output(first) && writes_output(second));
}

void add(IssueSlot& slot, const Instruction& instruction) {
  slot.reads |= reads_of(instruction);
  if (is_scalar(instruction.opcode)) {
    slot.has_scalar = true;
    slot.scalar_writes |= writes_of(instruction);
  } else {
    slot.has_vector = true;
    slot.vector_writes |= writes_of(instruction);
  }
}

}  // namespace

std::vector<IssueSlot> issue_slots(const isa::Program& program, const Machine::Vertex& spec) {
  std::vector<Instruction> instructions;
  for (const Instruction& instruction : program.instructions) {
    for (const Instruction& part : expanded(instruction, program.version)) instructions.push_back(part);
  }
  std::vector<IssueSlot> slots;
  for (std::size_t i = 0; i < instructions.size(); ++i) {
    IssueSlot& slot = slots.emplace_back();
    add(slot, instructions[i]);
    if (spec.pairing && i + 1 < instructions.size() && can_pair(instructions[i], instructions[i + 1])) {
      add(slot, instructions[++i]);
    }
  }
  return slots;
}

IssueLogic::IssueLogic(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec)
    : slots_(&slots),
      vector_latency_(static_cast<Cycle>(spec.vector_latency)),
      scalar_latency_(static_cast<Cycle>(spec.scalar_latency)),
      scalar_interval_(static_cast<Cycle>(spec.scalar_interval)),
      threads_(static_cast<std::size_t>(spec.threads)) {}

void IssueLogic::start(int vertices) {
  vertices_ = static_cast<std::size_t>(vertices);
  for (Thread& thread : threads_) thread = {};
  turn_ = 0;
  left_ = vertices_ * slots_->size();
  now_ = 0;
  scalar_free_ = 0;
  last_result_ = 0;
}

bool IssueLogic::can_issue(const Thread& thread, const IssueSlot& slot) const {
  if (slot.has_scalar && scalar_free_ > now_) return false;
  for (ComponentMask reads = slot.reads; reads != 0; reads &= reads - 1) {
    if (thread.ready[static_cast<std::size_t>(std::countr_zero(reads))] > now_) return false;
  }
  // Results of one component arrive in order.
  const auto in_order = [&](ComponentMask writes, Cycle latency) {
    for (; writes != 0; writes &= writes - 1) {
      if (thread.ready[static_cast<std::size_t>(std::countr_zero(writes))] > now_ + latency) return false;
    }
    return true;
  };
  return in_order(slot.vector_writes, vector_latency_) && in_order(slot.scalar_writes, scalar_latency_);
}

void IssueLogic::record(Thread& thread, ComponentMask writes, Cycle latency) {
  for (; writes != 0; writes &= writes - 1) {
    thread.ready[static_cast<std::size_t>(std::countr_zero(writes))] = now_ + latency;
  }
  last_result_ = std::max(last_result_, now_ + latency);
}

int IssueLogic::issue() {
  int issued = -1;
  for (std::size_t i = 0; i < vertices_ && issued < 0; ++i) {
    const std::size_t candidate = (turn_ + i) % vertices_;
    Thread& thread = threads_[candidate];
    if (thread.slot == slots_->size() || !can_issue(thread, (*slots_)[thread.slot])) continue;
    const IssueSlot& slot = (*slots_)[thread.slot++];
    if (slot.has_vector) record(thread, slot.vector_writes, vector_latency_);
    if (slot.has_scalar) {
      record(thread, slot.scalar_writes, scalar_latency_);
      scalar_free_ = now_ + scalar_interval_;
    }
    turn_ = (candidate + 1) % vertices_;
    --left_;
    issued = static_cast<int>(candidate);
  }
  ++now_;
  return issued;
}

std::vector<GroupSchedule> group_schedules(const std::vector<IssueSlot>& slots, const Machine::Vertex& spec) {
  std::vector<GroupSchedule> schedules;
  IssueLogic logic(slots, spec);
  for (int vertices = 1; vertices <= spec.threads; ++vertices) {
    logic.start(vertices);
    while (!logic.done()) logic.issue();
    schedules.push_back({logic.now(), logic.last_result()});
  }
  return schedules;
}

double clocks_per_vertex(const isa::Program& program, const Machine::Vertex& spec) {
  const auto slots = issue_slots(program, spec);
  const Cycle group =
      group_schedules(slots, spec).back().issue_cycles + static_cast<Cycle>(spec.group_start_cycles);
  return static_cast<double>(group) / spec.threads;
}

}  // namespace splatscope::sim
