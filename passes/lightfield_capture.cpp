#include "passes/lightfield_capture.hpp"

#include <algorithm>
#include <chrono>
#include <string>

#include "engine/base/assert.hpp"
#include "engine/base/error.hpp"
#include "engine/base/file.hpp"
#include "engine/base/log.hpp"
#include "engine/base/progress.hpp"
#include "kernels/trace.gen.hpp"
#include "passes/lightfield_capture_state.hpp"
#include "shaders/shared/rgb9e5.h"

namespace strandlight {
namespace {

// A slice's accumulator: large enough to fill a device, small enough to lose little when
// interrupted.
constexpr std::uint32_t kSliceCells = 1u << 16u;

std::span<const std::uint8_t> bytesOf(const std::vector<gpu::CapturePoint>& points)
{
    return {reinterpret_cast<const std::uint8_t*>(points.data()),
            points.size() * sizeof(points[0])};
}

// More than half of what the texel sees are backs of closed surfaces; or nothing but backs, and no
// light.
bool liesInside(const std::uint32_t* kinds, bool black)
{
    const std::uint64_t front = kinds[0], singleBack = kinds[1], doubleBack = kinds[2];
    const std::uint64_t total = front + singleBack + doubleBack + kinds[3];
    if (total == 0)
        return true;
    if (2 * singleBack > total)
        return true;
    return black && 20 * (singleBack + doubleBack) >= 19 * total;
}

} // namespace

std::uint64_t lightfieldCaptureBytes(std::uint64_t texels, std::uint32_t size, bool environment)
{
    const std::uint64_t cells = std::uint64_t(size) * size;
    const std::uint64_t slice = std::max<std::uint64_t>(1, kSliceCells / cells); // texels
    const std::uint64_t words =
        gpu::kTraceCounters + slice * gpu::kPrimaryKinds + texels * cells * (environment ? 2 : 1);
    return texels * sizeof(gpu::CapturePoint) + slice * cells * 2 * sizeof(glm::vec4) +
           words * sizeof(std::uint32_t);
}

LightfieldPart& LightfieldCapture::State::partOf(std::uint32_t texel)
{
    const auto part = std::find_if(field.parts.begin(), field.parts.end(), [&](const auto& p) {
        return texel < p.firstTexel + p.texelCount;
    });
    STRANDLIGHT_ASSERT(part != field.parts.end());
    return *part;
}

LightfieldCapture::LightfieldCapture(Context& context, GpuScene& scene,
                                     std::vector<gpu::CapturePoint> points,
                                     const CaptureSettings& settings)
    : state_(std::make_unique<State>(context, scene, settings))
{
    if (settings.size == 0 || settings.size > 256 || settings.samplesPerDirection == 0)
        throw Error("light field images of " + std::to_string(settings.size) +
                    " cells a side with " + std::to_string(settings.samplesPerDirection) +
                    " samples");
    const std::uint64_t cells = std::uint64_t(settings.size) * settings.size;
    if (points.size() * cells > 0xffffffffull)
        throw Error("light field of " + std::to_string(points.size()) + " texels with " +
                    std::to_string(cells) + " directions each is too large");
    State& s = *state_;
    s.pointsCrc = crc32(bytesOf(points));
    s.sliceTexels = std::max(1u, std::uint32_t(kSliceCells / cells));
    s.points = Buffer::from(context, points, "capture points");
    s.accumulator = Buffer(context, s.sliceTexels * cells * 2 * sizeof(glm::vec4), "capture sums");
    s.counters = Buffer(context, gpu::kTraceCounters * sizeof(std::uint32_t), "trace counters");
    s.primaries =
        Buffer(context, std::uint64_t(s.sliceTexels) * gpu::kPrimaryKinds * sizeof(std::uint32_t),
               "capture primaries");

    s.field.size = settings.size;
    s.field.texelCount = std::uint32_t(points.size());
    s.field.hasEnvironment = scene.has(gpu::kFeatureEnvironment);
    s.field.valid.assign(points.size(), 1);
    const auto perPart = std::uint32_t(
        std::min<std::uint64_t>(context.maxStorageBufferBytes() / (cells * 4), 0xffffffffu));
    for (std::uint32_t first = 0; first < s.field.texelCount; first += perPart) {
        LightfieldPart part;
        part.firstTexel = first;
        part.texelCount = std::min(perPart, s.field.texelCount - first);
        part.radiance = Buffer(context, part.texelCount * cells * 4, "light field");
        if (s.field.hasEnvironment)
            part.environment =
                Buffer(context, part.texelCount * cells * 4, "light field environment");
        s.field.parts.push_back(std::move(part));
    }
}

LightfieldCapture::~LightfieldCapture() = default;

std::uint32_t LightfieldCapture::completedTexels() const
{
    return state_->completed;
}
std::uint32_t LightfieldCapture::texelCount() const
{
    return state_->field.texelCount;
}
const TraceStatistics& LightfieldCapture::statistics() const
{
    return state_->statistics;
}

bool LightfieldCapture::step()
{
    State& s = *state_;
    if (s.completed < s.field.texelCount) {
        const auto start = std::chrono::steady_clock::now();
        const LightfieldPart& part = s.partOf(s.completed);
        const std::uint32_t count =
            std::min(s.sliceTexels, part.firstTexel + part.texelCount - s.completed);
        s.captureSlice(s.completed, count);
        s.completed += count;
        s.statistics.seconds +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        s.statistics.slowestDispatchMs = s.planner.slowestMs();
    }
    return s.completed == s.field.texelCount;
}

void LightfieldCapture::State::captureSlice(std::uint32_t first, std::uint32_t count)
{
    // An interrupted slice may have left sums behind.
    RenderGraph graph(context);
    PassBuilder clear = graph.addTransferPass("clear capture");
    clear.fill(clear.write(graph.importBuffer(accumulator)), 0);
    clear.fill(clear.write(graph.importBuffer(primaries)), 0);
    graph.run();

    const std::uint32_t cells = count * field.directionCount();
    std::uint32_t cell = 0;
    while (cell < cells) {
        const std::uint32_t range = std::min(planner.items(), cells - cell);
        traceRange(first, cell, range);
        cell += range;
    }
    LightfieldPart& part = partOf(first);
    packSlice(part, first, count);
    markInvalid(part, first, count);
}

void LightfieldCapture::State::traceRange(std::uint32_t firstTexel, std::uint32_t firstCell,
                                          std::uint32_t count)
{
    gpu::CapturePush push{};
    push.grid = scene.grid;
    push.triangleCount = scene.triangleCount;
    push.firstTexel = firstTexel;
    push.firstCell = firstCell;
    push.cellCount = count;
    push.size = settings.size;
    push.samples = settings.samplesPerDirection;
    push.seed = settings.seed;
    push.bounces = settings.bounces;

    std::uint32_t unfinished = count;
    while (unfinished > 0) {
        throwIfInterrupted();
        const auto before = std::chrono::steady_clock::now();
        RenderGraph graph(context);
        PassBuilder clear = graph.addTransferPass("clear trace counters");
        BufferId numbers = clear.write(graph.importBuffer(counters));
        clear.fill(numbers, 0);
        PassBuilder pass = graph.addComputePass("light field capture");
        const auto import = [&](Buffer& buffer) {
            return pass.read(graph.importBuffer(scene.orDummy(buffer)));
        };
        numbers = pass.write(numbers);
        const BufferId sums = pass.write(graph.importBuffer(accumulator));
        const BufferId kinds = pass.write(graph.importBuffer(primaries));
        pass.dispatch(kernels::lightfield_capture, {count, 1, 1}, push,
                      {sums, numbers, kinds, import(points), import(scene.nodes),
                       import(scene.triangles), import(scene.corners), import(scene.materials),
                       import(scene.lightTable), import(scene.textures), import(scene.environment),
                       import(scene.lights)},
                      {scene.features});
        graph.run();
        planner.finished(count, std::chrono::duration<double, std::milli>(
                                    std::chrono::steady_clock::now() - before)
                                    .count());
        const auto results = counters.downloadAs<std::uint32_t>();
        unfinished = results[0];
        statistics.lostRays += results[1];
        statistics.rejectedSamples += results[2];
        ++statistics.dispatches;
    }
}

void LightfieldCapture::State::packSlice(LightfieldPart& part, std::uint32_t first,
                                         std::uint32_t count)
{
    RenderGraph graph(context);
    PassBuilder clear = graph.addTransferPass("clear trace counters");
    BufferId numbers = clear.write(graph.importBuffer(counters));
    clear.fill(numbers, 0);
    PassBuilder pass = graph.addComputePass("light field pack");
    numbers = pass.write(numbers);
    const BufferId sums = pass.write(graph.importBuffer(accumulator));
    const BufferId radiance = pass.write(graph.importBuffer(part.radiance));
    // Without an environment the second image is bound to the first and not written.
    const BufferId environment =
        field.hasEnvironment ? pass.write(graph.importBuffer(part.environment)) : radiance;
    const gpu::CapturePackPush push{count * field.directionCount(),
                                    (first - part.firstTexel) * field.directionCount(),
                                    settings.samplesPerDirection, field.hasEnvironment ? 1u : 0u};
    pass.dispatch(kernels::lightfield_pack, {push.cellCount, 1, 1}, push,
                  {sums, radiance, environment, numbers});
    graph.run();
    field.clampedCells += counters.downloadAs<std::uint32_t>()[3];
}

void LightfieldCapture::State::markInvalid(const LightfieldPart& part, std::uint32_t first,
                                           std::uint32_t count)
{
    const auto kinds = primaries.downloadAs<std::uint32_t>();
    std::vector<std::uint32_t> words;
    for (std::uint32_t i = 0; i < count; ++i) {
        // Only texels that see backs need a look at their light.
        const std::uint32_t* own = &kinds[std::size_t(i) * gpu::kPrimaryKinds];
        bool black = false;
        if (own[0] == 0 || own[1] + own[2] > 18 * own[0]) {
            if (words.empty())
                words = part.radiance.downloadAs<std::uint32_t>();
            const auto begin =
                words.begin() +
                std::ptrdiff_t(std::size_t(first + i - part.firstTexel) * field.directionCount());
            black = std::all_of(begin, begin + field.directionCount(), [](std::uint32_t w) {
                return gpu::unpackRgb9e5(w) == glm::vec3(0.0f);
            });
        }
        field.valid[first + i] = liesInside(own, black) ? 0 : 1;
    }
}

Lightfield LightfieldCapture::finish()
{
    State& s = *state_;
    STRANDLIGHT_ASSERT_EQ(s.completed, s.field.texelCount);
    if (s.statistics.lostRays > 0 || s.statistics.rejectedSamples > 0)
        logWarning("capture: " + std::to_string(s.statistics.lostRays) + " rays gave up, " +
                   std::to_string(s.statistics.rejectedSamples) + " samples were not finite");
    if (s.field.clampedCells > 0)
        logWarning("capture: " + std::to_string(s.field.clampedCells) +
                   " cells are brighter than 65408 and were clamped");
    return std::move(s.field);
}

Lightfield captureLightfield(Context& context, const Scene& scene, GpuScene& device,
                             const Atlas& atlas, const CaptureSettings& settings,
                             TraceStatistics* statistics)
{
    LightfieldCapture capture(context, device, capturePoints(scene, atlas), settings);
    Progress progress("capture", std::max(capture.texelCount(), 1u));
    while (!capture.step())
        progress.update(capture.completedTexels());
    progress.update(capture.texelCount());
    if (statistics != nullptr)
        *statistics = capture.statistics();
    return capture.finish();
}

} // namespace strandlight
