// SPDX-License-Identifier: GPL-3.0-or-later

#include "ParticleDrag.H"

namespace
{

bedFoam::DragLaw namedDragLaw(const dictionary& gas)
{
    const std::string name = gas.get<word>("drag");
    const bedFoam::DragLaw law = bedFoam::dragLaw(name);
    if (!law)
    {
        FatalIOErrorInFunction(gas) << "drag law " << name << " does not exist; there are";
        for (const std::string& known : bedFoam::dragLawNames()) FatalIOError << ' ' << known;
        FatalIOError << exit(FatalIOError);
    }
    return law;
}

}

bedFoam::ParticleDrag::ParticleDrag(const Properties& properties, const SlabGrid& grid, const dictionary& gas)
    : properties_(properties),
      grid_(grid),
      law_(namedDragLaw(gas))
{}

void bedFoam::ParticleDrag::update(
    const Liggghts& dem, const std::vector<Stencil>& stencils, const volVectorField& U,
    const volScalarField& voidage
)
{
    using Four = std::array<double, 4>;
    SlabField<4> gas = grid_.fieldOf<4>(
        [&](Four& value, label cell)
        {
            for (direction d = 0; d < 3; ++d) value[d] = U[cell][d];
            value[3] = voidage[cell];
        }
    );
    grid_.prepareSample<4>(gas);

    const double* const* velocity = dem.velocity();
    const double* const* dragged = dem.draggedVelocity();
    drags_.resize(stencils.size());
    for (size_t i = 0; i < drags_.size(); ++i)
    {
        const Four around = grid_.sample<4>(gas, stencils[i]);
        const double slip = std::sqrt(
            sqr(around[0] - velocity[i][0]) + sqr(around[1] - velocity[i][1])
            + sqr(around[2] - velocity[i][2])
        );
        const double explicitDrag = properties_.grains
            * law_({around[3], properties_.grain, slip, properties_.gasDensity, properties_.gasViscosity});
        drags_[i].coefficient = explicitDrag / (1 + properties_.interval * explicitDrag / properties_.mass);
        for (int d = 0; d < 3; ++d) drags_[i].undragged[d] = 2 * velocity[i][d] - dragged[i][d];
    }
}
