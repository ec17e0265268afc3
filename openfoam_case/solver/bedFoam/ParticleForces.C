// SPDX-License-Identifier: GPL-3.0-or-later

#include "ParticleForces.H"

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
    double* const* dragged = dem.draggedVelocity();
    vector dragOnParticles = Zero;
    scalar dragSize = 0, lift = 0;
    for (size_t i = 0; i < drags.size(); ++i)
    {
        const Six around = grid_.sample<6>(values, stencils[i]);
        for (int d = 0; d < 3; ++d)
        {
            // Across a single layer even a force of round-off would make the bed buckle. Where one gas cell
            // spans many layers the gas does not move across them and its pressure is even, but it drags
            const bool moves = mesh.solutionD()[d] > 0 || freeAcross_;
            const double drag = moves ? drags[i].coefficient * (around[d] - drags[i].undragged[d]) : 0;
            const double buoyancy = d == 2 ? displaced * properties_.gravity : 0;
            const double pressure = mesh.solutionD()[d] > 0 ? -displaced * around[d + 3] : 0;
            force[i][d] = drag + pressure + buoyancy;
            dragged[i][d] = velocity[i][d] + properties_.interval * drag / properties_.mass;
            dragOnParticles[d] += drag;
            dragSize += std::abs(drag);
            if (d == 2) lift += drag + pressure;
        }
    }
    reduce(lift, sumOp<scalar>());
    shareOnGas_ =
        lift / max(properties_.weight * returnReduce(scalar(drags.size()), sumOp<scalar>()), VSMALL);

    const vector dragOnGas = properties_.gasDensity * grid_.cellVolume()
        * sum(solids.dragSource.primitiveField() - solids.dragRate.primitiveField() * gas.U.primitiveField());
    dragImbalance_ = mag(returnReduce(dragOnParticles + dragOnGas, sumOp<vector>()))
        / max(returnReduce(dragSize, sumOp<scalar>()), VSMALL);
}
