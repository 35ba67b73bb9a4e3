// Stands in for libFuzzer in ordinary builds: every file of the seed corpus, and random mutations of them for
// some seconds. Usage: FUZZER CORPUS_FOLDER SECONDS [SEED]
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Input = std::string;

void run(const Input& input) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

std::vector<Input> read_corpus(const char* folder) {
  std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(folder),
                                           std::filesystem::directory_iterator{});
  std::ranges::sort(files);
  std::vector<Input> corpus;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return corpus;
}

// Bytes changed, cut out, doubled, and pieces of another input.
Input mutated(const std::vector<Input>& corpus, std::mt19937& random) {
  const auto below = [&](std::size_t count) { return count == 0 ? 0 : random() % count; };
  Input input = corpus[below(corpus.size())];
  for (std::size_t changes = 1 + below(4); changes > 0; --changes) {
    const std::size_t at = below(input.size() + 1);
    const Input& other = corpus[below(corpus.size())];
    switch (below(5)) {
      case 0:
        if (at < input.size()) input[at] = static_cast<char>(random());
        break;
      case 1:
        if (at < input.size()) input[at] = static_cast<char>(input[at] ^ (1 << below(8)));
        break;
      case 2:
        input.erase(at, below(16));
        break;
      case 3:
        input.insert(at, input.substr(below(input.size() + 1), below(64)));
        break;
      default:
        input.insert(at, other.substr(below(other.size() + 1), below(64)));
        break;
    }
  }
  return input;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: " << argv[0] << " CORPUS_FOLDER SECONDS [SEED]\n";
    return 2;
  }
  const auto seed =
      argc > 3 ? static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10)) : std::random_device{}();
  std::cout << "seed " << seed << '\n' << std::flush;  // before a crash
  std::mt19937 random(seed);
  const std::vector<Input> corpus = read_corpus(argv[1]);
  if (corpus.empty()) return 1;
  for (const Input& input : corpus) run(input);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::stoi(argv[2]));
  std::size_t runs = 0;
  for (; std::chrono::steady_clock::now() < end; ++runs) run(mutated(corpus, random));
  std::cout << runs << " mutations of " << corpus.size() << " inputs\n";
}
