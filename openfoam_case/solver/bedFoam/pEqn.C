// SPDX-License-Identifier: GPL-3.0-or-later
//
// Gas volume balance, closed: d(e)/dt + div(e U) = 0 with e the particles' own voidage
//
// The face's momentum is the mean of its two cells' momentum over e, A/e U = H/e - grad(p): where drag
// jumps, as at the top of the bed, their resistances are in series. There the pressure gradient of a cell
// jumps too, and no difference over two cells has it: the cell's velocity is put together from the fluxes,
// and only what they do not see (shorter than two cells) from its own momentum.

#include "constrainHbyA.H"
#include "constrainPressure.H"
#include "fvCFD.H"

#include "gasEquations.H"

namespace
{

//- Flux of H/A: by the faces' momentum inside and between ranks, by HbyA on the other patches
surfaceScalarField fluxWithoutPressure(
    const fvVectorMatrix& UEqn, const volVectorField& HbyA, const surfaceScalarField& rAUf,
    const volScalarField& voidage
)
{
    surfaceScalarField phiHbyA("phiHbyA", fvc::flux(HbyA));
    const surfaceScalarField momentum = rAUf * fvc::flux(UEqn.H() / voidage);
    phiHbyA.primitiveFieldRef() = momentum.primitiveField();
    forAll(phiHbyA.boundaryField(), patch)
    {
        if (!HbyA.mesh().boundary()[patch].coupled()) continue;
        phiHbyA.boundaryFieldRef()[patch] = momentum.boundaryField()[patch];
    }
    return phiHbyA;
}

}

void bedFoam::solvePressure(
    const fvVectorMatrix& UEqn, const SolidsFields& solids, const surfaceScalarField& voidagef,
    const Guards& guards, pisoControl& piso, GasFields& gas
)
{
    const volScalarField& voidage = solids.voidage;
    volScalarField& p = gas.p;
    volVectorField& U = gas.U;

    const volScalarField rAU("rAU", 1 / UEqn.A());
    const volScalarField rAUfree("rAUfree", 1 / (UEqn.A() - solids.dragRate));
    const surfaceScalarField rAUf("rAUf", 1 / fvc::interpolate(UEqn.A() / voidage));

    const volVectorField HbyA = constrainHbyA(rAU * UEqn.H(), U, p);
    const volVectorField HbyAfree = constrainHbyA(rAUfree * (UEqn.H() - solids.dragSource), U, p);

    surfaceScalarField phiHbyA = fluxWithoutPressure(UEqn, HbyA, rAUf, voidage);
    phiHbyA += rAUf * fvc::ddtCorr(U, gas.phi);
    constrainPressure(p, U, phiHbyA, rAUf);

    while (piso.correctNonOrthogonal())
    {
        fvScalarMatrix pEqn(
            fvm::laplacian(voidagef * rAUf, p) == fvc::ddt(voidage) + fvc::div(voidagef * phiHbyA)
        );
        guards.checkPressure(pEqn.solve(p.mesh().solver(p.select(piso.finalInnerIter()))), pEqn);
        if (piso.finalNonOrthogonalIter()) gas.phi = phiHbyA - pEqn.flux() / voidagef;
    }

    U = fvc::reconstruct(gas.phi) + (rAU / rAUfree) * (HbyAfree - fvc::reconstruct(fvc::flux(HbyAfree)));
    U.correctBoundaryConditions();
    gas.gradP = (UEqn.H() - UEqn.A() * U) / voidage;
}

scalar bedFoam::volumeImbalance(
    const volScalarField& voidage, const surfaceScalarField& voidagef, const surfaceScalarField& phi
)
{
    const scalarField imbalance =
        (fvc::ddt(voidage) + fvc::div(voidagef * phi))().primitiveField() * voidage.time().deltaTValue();
    return gMax(mag(imbalance)());
}
