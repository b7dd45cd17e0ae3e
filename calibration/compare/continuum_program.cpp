// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/continuum_program.h"

#include "base/program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace boba::calibration {

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> command_line(const std::string& problem, const ContinuumModel& model, const fs::path& folder) {
  std::vector<std::string> words = {problem,
                                    fmt::format("--radius={:.10g}", model.radius),
                                    fmt::format("--young={:.10g}", model.young),
                                    fmt::format("--poisson={:.10g}", model.poisson),
                                    "--output=" + folder.string(),
                                    "--force"};
  if (model.c1 > 0.0) {
    words.insert(words.end(), {"--interface=compliant", fmt::format("--c1={:.10g}", model.c1),
                               fmt::format("--c3={:.10g}", model.c3)});
  }
  if (!model.law.empty()) {
    words.insert(words.end(), {"--kinematics=finite", "--law=" + model.law});
  }
  if (model.law == "foam") {
    words.insert(words.end(), {"--fit=" + model.compression.string(), fmt::format("--fit-terms={}", model.foam_terms)});
  }
  words.insert(words.end(), model.more.begin(), model.more.end());
  return words;
}

} // namespace

nlohmann::json run_continuum(const std::string& problem, const ContinuumModel& model, const std::string& load_option,
                             std::vector<double> loads, const fs::path& folder) {
  const fs::path own = folder / (problem + "_" + model.name), log = folder / (problem + "_" + model.name + ".log");
  fs::create_directories(own);
  const fs::path program = program_beside("boba-continuum");
  while (!loads.empty()) {
    std::vector<std::string> words = command_line(problem, model, own);
    words.push_back(fmt::format("--{}={:.10g}", load_option, fmt::join(loads, ",")));
    const int code = run_process(program, words, log);
    if (code == 0) {
      return nlohmann::json::parse(text_of(own / "summary.json")).at("loads");
    }
    if (code != 1) { // 1: an iteration that did not settle
      throw std::runtime_error(fmt::format("boba-continuum {} ended with code {}: {}", problem, code, text_of(log)));
    }
    loads.pop_back();
  }
  return nlohmann::json::array();
}

} // namespace boba::calibration
