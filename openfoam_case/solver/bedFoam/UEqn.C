// SPDX-License-Identifier: GPL-3.0-or-later
//
// Momentum of the gas, model A, over the gas density:
//   d(e U)/dt + div(e U U) = -e grad(p) + div(e tau) + dragSource - dragRate U

#include "fvCFD.H"

#include "gasEquations.H"

tmp<fvVectorMatrix> bedFoam::solveMomentum(
    const SolidsFields& solids, const surfaceScalarField& voidagef, const dimensionedScalar& viscosity,
    const pisoControl& piso, GasFields& gas
)
{
    volVectorField& U = gas.U;
    const surfaceScalarField voidagePhi("voidagePhi", voidagef * gas.phi);
    const volScalarField effectiveViscosity("effectiveViscosity", solids.voidage * viscosity);

    const tmp<volVectorField> stressOfTranspose =
        fvc::div(effectiveViscosity * dev2(T(fvc::grad(U))), "div(viscousStress)");

    tmp<fvVectorMatrix> UEqn(
        fvm::ddt(solids.voidage, U)                 // rate
            + fvm::div(voidagePhi, U)               // convection
            - fvm::laplacian(effectiveViscosity, U) // viscous stress: of the gradient
            - stressOfTranspose                     // and of its transpose
            + fvm::Sp(solids.dragRate, U)           // drag
        == solids.dragSource
    );

    if (piso.momentumPredictor()) solve(UEqn() == -solids.voidage * gas.gradP);
    return UEqn;
}
