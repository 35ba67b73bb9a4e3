#include "studies/reproduction/zwicker_machine.h"

#include <fmt/format.h>

#include <array>

#include "kernels/reference/volume/fast_volume.h"
#include "model/machine/parameters.h"
#include "studies/measure.h"
#include "traces/volume_trace.h"

namespace splatscope::studies {
namespace {

constexpr int kFrame = 512;
constexpr std::string_view kMachines[] = {machine::kRadeon8500, machine::kGeForce4};
constexpr FrameFormat kFormats[] = {FrameFormat::unorm8, FrameFormat::unorm10, FrameFormat::half,
                                    FrameFormat::unorm16, FrameFormat::float32};

kernels::VolumeSettings software_settings() {
  const traces::VolumeTraceSettings machine;
  return {.cutoff = machine.cutoff, .light = machine.light};
}

// The software's picture, and where there is anything in it.
struct Reference {
  Image image;
  std::vector<unsigned char> covered;

  explicit Reference(const VolumeModel& model) {
    const kernels::VolumePicture picture =
        kernels::volume_picture(model.view, model.splats, software_settings());
    image = opaque_image(picture.width, picture.height, picture.pixels);
    for (const glm::dvec4& pixel : picture.pixels) covered.push_back(pixel.w > 0.5 / 255);
  }
  double psnr_of(const Frame& frame) const { return psnr(picture_of(frame), image, covered); }
};

VolumeFrame frame_of(const Machine& machine, const FrameRun& run, const Reference& reference) {
  return {machine.name, reference.psnr_of(run.rendered.frame), run.timing->seconds, rate_of(*run.timing)};
}

Frame float_frame(const VolumeModel& model) {
  RenderOptions options;
  options.formats.frame = FrameFormat::float32;
  options.formats.color = ColorFormat::float32;
  options.formats.subpixel_bits = 8;
  options.record = Record::nothing;
  const traces::VolumeTraceSettings settings{
      .texture_length = 2048, .texture_bits = 16, .float_colors = true};
  return render(traces::volume_trace(model.view, model.splats, settings).trace, options).frame;
}

double software_seconds(const VolumeModel& model) {
  kernels::FastVolume fast(model.splats);
  double least = 1e30;
  for (int i = 0; i < 3; ++i) {
    const auto start = HostClock::now();
    fast.draw(model.view, software_settings());
    least = std::min(least, seconds_since(start));
  }
  return least;
}

std::string time_of(const VolumeFrame& frame) {
  return fmt::format("{:.2f} fps", frame.rate.fps);
}

std::string text_of(const VolumeRow& row) {
  std::string text = fmt::format(
      "zwicker-fig16 {:<6} {} x {} x {}: {} splats ({} flat) in {} sheets, {:.0f} MB of vertices; "
      "{:.1f} dB in float\n",
      row.name, row.size.x, row.size.y, row.size.z, row.splats, row.flat, row.sheets,
      static_cast<double>(row.vertex_bytes) / 1e6, row.psnr_float);
  for (const VolumeFrame& frame : row.frames)
    text += fmt::format("  {:<15} {:>9}  {:<8} {:>3.0f} %  {:.1f} dB\n", frame.machine, time_of(frame),
                        frame.rate.bottleneck, 100 * frame.rate.share, frame.psnr);
  return text + fmt::format("  software         {:>5.2f} fps  on this host\n", 1 / row.software_seconds);
}

nlohmann::ordered_json json_of(const VolumeFrame& frame) {
  return {{"machine", frame.machine},
          {"psnr_decibels", frame.psnr},
          {"milliseconds", 1000 * frame.seconds},
          {"fps_simulated", frame.rate.fps},
          {"bottleneck", frame.rate.bottleneck},
          {"bottleneck_busy_share", frame.rate.share}};
}

nlohmann::ordered_json json_of(const VolumeRow& row) {
  auto frames = nlohmann::ordered_json::array();
  for (const VolumeFrame& frame : row.frames) frames.push_back(json_of(frame));
  return {{"volume", row.name},
          {"stand_in", row.stand_in},
          {"voxels", {row.size.x, row.size.y, row.size.z}},
          {"splats", row.splats},
          {"flat_splats", row.flat},
          {"sheets", row.sheets},
          {"vertex_bytes", row.vertex_bytes},
          {"psnr_float_decibels", row.psnr_float},
          {"software_seconds", row.software_seconds},
          {"machines", frames}};
}

void add_table(Report& report, const std::vector<VolumeRow>& rows) {
  using enum Report::Align;
  std::vector<std::vector<std::string>> cells;
  for (const VolumeRow& row : rows) {
    for (const VolumeFrame& frame : row.frames) {
      cells.push_back({row.name, row.stand_in, fmt::format("{}", row.splats), fmt::format("{}", row.sheets),
                       fmt::format("{:.1f}", frame.psnr), fmt::format("{:.1f}", row.psnr_float),
                       frame.machine, fmt::format("{:.2f}", frame.rate.fps), text_of_bottleneck(frame.rate)});
    }
  }
  report.table(
      "Volumes by EWA splatting on the machines; the paper's software took about 11 s a frame on an 866 MHz "
      "PIII. PSNR: against the software's picture with the same sheets, over the pixels that the volume "
      "covers.",
      {{"volume"},
       {"stand-in"},
       {"splats", number},
       {"sheets", number},
       {"dB, 8 bits", number},
       {"dB, float", number},
       {"machine"},
       {"simulated fps", number},
       {"bottleneck"}},
      cells);
}

std::string text_of(const std::vector<StepRow>& rows) {
  std::string text = "zwicker-fig16 the same, dB by what is wide          sums as they are  with gains\n";
  for (const StepRow& row : rows)
    text +=
        fmt::format("              {:<37} {:>16.1f} {:>11.1f}\n", row.wide, row.psnr_plain, row.psnr_gains);
  return text;
}

nlohmann::ordered_json json_of(const std::vector<StepRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const StepRow& row : rows) {
    list.push_back({{"wide", row.wide},
                    {"psnr_plain_decibels", row.psnr_plain},
                    {"psnr_gains_decibels", row.psnr_gains}});
  }
  return list;
}

std::string text_of(const std::vector<FormatRow>& rows) {
  std::string text = fmt::format(
      "zwicker-fig16 the engine with half the voxels and pixels along each axis, by frame format\n"
      "              {:<9}",
      "format");
  for (const std::string_view machine : kMachines) text += fmt::format("  {:>34}", machine);
  text += "\n";
  for (const FormatRow& row : rows) {
    text += fmt::format("              {:<9}", machine::name(row.format));
    for (const VolumeFrame& frame : row.frames)
      text += fmt::format("  {:>4.1f} dB {:>9} {:<9} {:>4.0f} %", frame.psnr, time_of(frame),
                          frame.rate.bottleneck, 100 * frame.rate.share);
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json json_of(const std::vector<FormatRow>& rows) {
  auto list = nlohmann::ordered_json::array();
  for (const FormatRow& row : rows) {
    auto frames = nlohmann::ordered_json::array();
    for (const VolumeFrame& frame : row.frames) frames.push_back(json_of(frame));
    list.push_back({{"format", machine::name(row.format)}, {"machines", frames}});
  }
  return list;
}

}  // namespace

VolumeRow volume_row(const VolumeModel& model, Fidelity fidelity, const Progress& progress) {
  VolumeRow row;
  row.name = model.name;
  row.stand_in = model.stand_in;
  row.size = model.size;
  const Reference reference(model);
  row.software = reference.image;
  row.software_seconds = software_seconds(model);
  row.psnr_float = reference.psnr_of(float_frame(model));
  if (progress) progress(0.4);
  const traces::VolumeTrace recorded = traces::volume_trace(model.view, model.splats, {});
  row.splats = recorded.splats;
  row.flat = recorded.flat;
  row.sheets = recorded.sheets;
  row.vertex_bytes = recorded.vertex_bytes;
  for (const std::string_view name : kMachines) {
    const Machine machine = machine::load(name);
    const FrameRun run = run_frame(recorded.trace, machine, fidelity);
    row.frames.push_back(frame_of(machine, run, reference));
    row.machine = picture_of(run.rendered.frame);
    tell(part(progress, 0.4, 1), row.frames.size(), std::size(kMachines));
  }
  return row;
}

std::vector<FormatRow> format_rows(const VolumeModel& model, Fidelity fidelity, const Progress& progress) {
  const Reference reference(model);
  const Trace trace = traces::volume_trace(model.view, model.splats, {}).trace;
  std::vector<FormatRow> rows;
  for (const FrameFormat format : kFormats) {
    FormatRow row{format, {}};
    for (const std::string_view machine_name : kMachines) {
      const Machine machine = with_frame(machine::load(machine_name), format);
      const FrameRun run = run_frame(trace, machine, fidelity);
      row.frames.push_back(frame_of(machine, run, reference));
    }
    rows.push_back(std::move(row));
    tell(progress, rows.size(), std::size(kFormats));
  }
  return rows;
}

std::vector<StepRow> step_rows(const VolumeModel& model, const Progress& progress) {
  const Reference reference(model);
  const Machine machine = machine::load(machine::kGeForce4);
  RenderOptions options;
  options.record = Record::nothing;
  const std::array<Trace, 2> traces{traces::volume_trace(model.view, model.splats, {.gains = false}).trace,
                                    traces::volume_trace(model.view, model.splats, {}).trace};
  std::vector<StepRow> rows;
  const auto add = [&](std::string wide, bool color, bool combiner, bool frame) {
    options.formats = machine.numbers;
    if (color) options.formats.color = ColorFormat::float32;
    if (combiner) options.formats.combiner = CombinerFormat::float32;
    if (frame) options.formats.frame = FrameFormat::float32;
    rows.push_back({std::move(wide), reference.psnr_of(render(traces[0], options).frame),
                    reference.psnr_of(render(traces[1], options).frame)});
    tell(progress, rows.size(), 6);
  };
  add("nothing", false, false, false);
  add("interpolated colours, what is blended", true, false, false);
  add("results of the pixel unit", false, true, false);
  add("frame and sheets", false, false, true);
  add("the first two", true, true, false);
  add("all", true, true, true);
  return rows;
}

void reproduce_zwicker_figure16(Findings& findings, const Progress& progress) {
  constexpr std::array kModels{volume_head, volume_engine, volume_foot};
  std::vector<VolumeRow> rows;
  auto list = nlohmann::ordered_json::array();
  findings.report().heading("Zwicker 2002, Fig. 16: volumes on the machines");
  for (const auto make : kModels) {
    const double done = 0.25 * static_cast<double>(rows.size());
    const VolumeModel model = make(kFrame, 1);
    rows.push_back(volume_row(model, Fidelity::throughput, part(progress, done, done + 0.25)));
    findings.text(text_of(rows.back()));
    list.push_back(json_of(rows.back()));
  }
  // A quarter of the pixels and an eighth of the voxels: the same footprints, in less time.
  const std::vector<FormatRow> formats =
      format_rows(volume_engine(kFrame / 2, 0.5), Fidelity::throughput, part(progress, 0.75, 0.95));
  findings.text(text_of(formats));
  const std::vector<StepRow> steps = step_rows(volume_engine(kFrame / 2, 0.5), part(progress, 0.95, 1));
  findings.text(text_of(steps));
  for (const VolumeRow& row : rows) {
    findings.pictures({{"zwicker-fig16-" + row.name + "-software", row.stand_in + ": software", row.software},
                       {"zwicker-fig16-" + row.name + "-machine",
                        fmt::format("{}: {} in 8 bits, {:.1f} dB", row.stand_in, row.frames.back().machine,
                                    row.frames.back().psnr),
                        row.machine}});
  }
  add_table(findings.report(), rows);
  findings.result("zwicker_fig16", list);
  findings.result("zwicker_fig16_formats", json_of(formats));
  findings.result("zwicker_fig16_steps", json_of(steps));
}

}  // namespace splatscope::studies
