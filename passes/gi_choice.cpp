#include "passes/gi_choice.hpp"

#include <vector>

#include "passes/sgl_lobe.hpp"

namespace strandlight {

bool isFree(const GiChoice& choice)
{
    return choice.representation == "direct" || choice.representation.starts_with("cnn");
}

SgField storedAs(const SgField& field, GiStorage storage)
{
    if (storage == GiStorage::Fp32)
        return field;
    const SglLobeCoding coding =
        chooseCoding(field, storage == GiStorage::Fp16 ? SglStorage::Fp16 : SglStorage::Packed);
    std::vector<std::uint8_t> bytes(sglBytesPerLobe(coding.storage));
    SgField stored = field;
    for (SgLobe& lobe : stored.lobes) {
        encodeLobe(lobe, coding, bytes);
        lobe = decodeLobe(bytes, coding);
    }
    return stored;
}

const char* toString(GiStorage storage)
{
    constexpr const char* kNames[] = {"fp32", "fp16", "packed"};
    return kNames[std::size_t(storage)];
}

const char* toString(SpecularModel model)
{
    return model == SpecularModel::Mixture ? "mixture"
           : model == SpecularModel::Asg   ? "asg"
                                           : "ndf";
}

const char* toString(DiffuseModel model)
{
    return model == DiffuseModel::Tokuyoshi ? "tokuyoshi"
           : model == DiffuseModel::Hill    ? "hill"
                                            : "wang";
}

} // namespace strandlight
