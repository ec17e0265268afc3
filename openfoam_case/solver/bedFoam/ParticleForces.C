// SPDX-License-Identifier: GPL-3.0-or-later

#include "ParticleForces.H"

#include <array>

bedFoam::ParticleForces::ParticleForces(
    const Properties& properties, const SlabGrid& grid, const dictionary& parameters
)
    : properties_(properties),
      grid_(grid),
      freeAcross_(parameters.get<label>("depth_walls") == 1)
{}

void bedFoam::ParticleForces::apply(
    const std::vector<Stencil>& stencils, const std::vector<Drag>& drags, const GasFields& gas,
    const SolidsFields& solids, Liggghts& dem
)
{
    using Six = std::array<double, 6>;
    SlabField<6> values = grid_.fieldOf<6>(
        [&](Six& value, label cell)
        {
            for (direction d = 0; d < 3; ++d)
            {
                value[d] = gas.U[cell][d];
                value[d + 3] = gas.gradP[cell][d];
            }
        }
    );
    grid_.prepareSample<6>(values);

    const fvMesh& mesh = gas.U.mesh();
    const double displaced = properties_.volume * properties_.gasDensity; // by a particle [kg]
    const double* const* velocity = dem.velocity();
    double* const* force = dem.force();
    double* const* keptVelocity = dem.draggedVelocity();
    // Across a single layer even a force of round-off would make the bed buckle. Where one gas cell
    // spans many layers the gas does not move across them and its pressure is even, but it drags
    std::array<bool, 3> dragged, pressed;
    for (int d = 0; d < 3; ++d)
    {
        pressed[d] = mesh.solutionD()[d] > 0;
        dragged[d] = pressed[d] || freeAcross_;
    }
    const double buoyancy = displaced * properties_.gravity;
    vector dragOnParticles = Zero;
    scalar dragSize = 0, lift = 0;
    for (size_t i = 0; i < drags.size(); ++i)
    {
        const Six around = grid_.sample<6>(values, stencils[i]);
        std::array<double, 3> drag, pressure;
        for (int d = 0; d < 3; ++d)
        {
            drag[d] = dragged[d] ? drags[i].coefficient * (around[d] - drags[i].undragged[d]) : 0;
            pressure[d] = pressed[d] ? -displaced * around[d + 3] : 0;
            force[i][d] = drag[d] + pressure[d];
            keptVelocity[i][d] = velocity[i][d] + properties_.interval * drag[d] / properties_.mass;
            dragOnParticles[d] += drag[d];
        }
        force[i][2] += buoyancy;
        dragSize += std::abs(drag[0]) + std::abs(drag[1]) + std::abs(drag[2]);
        lift += drag[2] + pressure[2];
    }
    reduce(lift, sumOp<scalar>());
    shareOnGas_ =
        lift / max(properties_.weight * returnReduce(scalar(drags.size()), sumOp<scalar>()), VSMALL);

    const vector dragOnGas = properties_.gasDensity * grid_.cellVolume()
        * sum(solids.dragSource.primitiveField() - solids.dragRate.primitiveField() * gas.U.primitiveField());
    dragImbalance_ = mag(returnReduce(dragOnParticles + dragOnGas, sumOp<vector>()))
        / max(returnReduce(dragSize, sumOp<scalar>()), VSMALL);
}
