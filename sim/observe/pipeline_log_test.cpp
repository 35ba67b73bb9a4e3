#include "sim/observe/pipeline_log.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "sim/testing/random_trace.h"

namespace splatscope::sim {
namespace {

using testing::RandomMaker;
using testing::RandomTrace;

struct Row {
  std::string label;
  std::string unit;
  Cycle begun = 0, issued = 0, ended = 0;
};

struct Log {
  std::vector<Row> rows;  // by number
  Result plain, result;
  std::string text;
  Cycle cut_at = 0;
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
  return cells;
}

// Reads a log as the format says (Kanata 0004), and expects of it: cycles only grow, rows are numbered as
// they begin, the stages of each follow each other, and each ends once, with the end of its last stage.
std::vector<Row> rows_of(const std::string& text) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ("Kanata\t0004", line);
  std::vector<Row> rows;
  std::vector<std::string> stages;  // of each row: the one that goes on
  std::size_t retired = 0;
  Cycle now = 0;
  bool is_begun = false;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = cells_of(line);
    const std::string& kind = cells[0];
    if (kind == "C=") {
      EXPECT_FALSE(is_begun);
      is_begun = true;
      now = std::stoull(cells[1]);
      continue;
    }
    EXPECT_TRUE(is_begun);
    const std::uint64_t number = std::stoull(cells[1]);
    if (kind == "C") {
      EXPECT_GT(number, 0u);
      now += number;
    } else if (kind == "I") {
      EXPECT_EQ(rows.size(), number);
      rows.emplace_back().begun = now;
      stages.emplace_back();
    } else if (kind == "L") {
      rows.at(number).label = cells[3];
      rows.at(number).unit = cells[3].substr(0, cells[3].find(' '));
    } else if (kind == "S") {
      EXPECT_EQ("", stages.at(number)) << line;
      stages[number] = cells[3];
      if (cells[3] == "X") rows[number].issued = now;
    } else if (kind == "E") {
      EXPECT_EQ(stages.at(number), cells[3]);
      if (cells[3] == "W") {
        EXPECT_GT(now, rows[number].begun) << "it did not wait";
      }
      stages[number] = "";
      if (cells[3] == "X") rows[number].ended = now;
    } else {
      EXPECT_EQ("R", kind);
      EXPECT_EQ("", stages.at(number));
      EXPECT_EQ(now, rows[number].ended);
      EXPECT_EQ(std::to_string(retired++), cells[2]);
      stages[number] = "retired";
    }
  }
  EXPECT_EQ(rows.size(), retired);
  return rows;
}

Log log_of(unsigned seed, const LogWindow& window, Scheduler scheduler = Scheduler::skip_ahead) {
  RandomMaker maker(seed);
  const RandomTrace made = maker.trace();
  const Machine machine = maker.machine();
  std::ostringstream text;
  PipelineLog pipeline(text, made.trace, window);
  Observer* const observers[] = {&pipeline};
  Log out;
  out.plain = simulate(made.trace, made.work, machine);
  out.result = simulate(made.trace, made.work, machine, scheduler, {}, observers);
  out.text = text.str();
  out.rows = rows_of(out.text);
  out.cut_at = pipeline.cut_at();
  return out;
}

std::uint64_t slots_of(const Result& result) {
  std::uint64_t slots = 0;
  for (const UnitStatistic& statistic : result.statistics) {
    if (statistic.name == "issue_slots") slots += statistic.value;
  }
  return slots;
}

// Every slot that the units count has a row; a unit issues one a cycle at most; nothing of the run changes,
// and the referee, which issues each slot by itself, tells the same.
TEST(PipelineLog, HasEverySlotOnceAndChangesNothing) {
  std::size_t rows = 0;
  for (const unsigned seed : {7u, 11u, 12u, 20u}) {
    const Log log = log_of(seed, {});
    EXPECT_EQ(log.plain.event_hash, log.result.event_hash) << seed;
    EXPECT_EQ(slots_of(log.result), log.rows.size()) << seed;
    EXPECT_EQ(kNever, log.cut_at);
    std::map<std::string, std::vector<Cycle>> issues;
    for (const Row& row : log.rows) {
      EXPECT_LE(row.begun, row.issued);
      EXPECT_LT(row.issued, row.ended);
      EXPECT_LE(row.ended, log.result.cycles);
      issues[row.unit].push_back(row.issued);
    }
    for (auto& [unit, cycles] : issues) {
      std::ranges::sort(cycles);
      EXPECT_EQ(cycles.end(), std::ranges::adjacent_find(cycles)) << unit << " issues twice in a cycle";
    }
    const Log referee = log_of(seed, {}, Scheduler::referee);
    EXPECT_EQ(referee.rows.size(), log.rows.size());
    const auto by_label = [](const Row& row) {
      return std::tuple(row.label, row.begun, row.issued, row.ended);
    };
    std::vector<std::tuple<std::string, Cycle, Cycle, Cycle>> skipped, plain;
    std::ranges::transform(log.rows, std::back_inserter(skipped), by_label);
    std::ranges::transform(referee.rows, std::back_inserter(plain), by_label);
    std::ranges::sort(skipped);
    std::ranges::sort(plain);
    EXPECT_EQ(plain, skipped) << seed;
    rows += log.rows.size();
  }
  EXPECT_GT(rows, 100u);
}

TEST(PipelineLog, ShowsTheWindowAloneAndStaysWithinItsBytes) {
  const Log all = log_of(7, {});
  ASSERT_GT(all.rows.size(), 50u);
  const Cycle first = all.rows.front().issued + 20, last = all.rows[all.rows.size() / 2].issued;
  const Log window = log_of(7, {.first = first, .last = last});
  EXPECT_GT(window.rows.size(), 5u);
  std::set<std::string> inside, shown;  // each slot of each vertex has a label of its own
  for (const Row& row : all.rows)
    if (row.issued >= first && row.issued <= last) inside.insert(row.label);
  for (const Row& row : window.rows) {
    EXPECT_GE(row.begun, first);
    shown.insert(row.label);
  }
  EXPECT_EQ(shown, inside);
  EXPECT_EQ(window.rows.size(), static_cast<std::size_t>(std::ranges::count_if(all.rows, [&](const Row& row) {
              return row.issued >= first && row.issued <= last;
            })));
  const Log cut = log_of(7, {.most_bytes = 4000});
  EXPECT_LE(cut.text.size(), 4000u);
  EXPECT_GT(cut.rows.size(), 5u);
  EXPECT_LE(cut.cut_at, cut.result.cycles);
}

}  // namespace
}  // namespace splatscope::sim
