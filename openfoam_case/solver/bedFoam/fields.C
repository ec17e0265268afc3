// SPDX-License-Identifier: GPL-3.0-or-later

#include "fvCFD.H"

#include "fields.H"

namespace
{

IOobject named(const char* name, const fvMesh& mesh, IOobject::readOption read, IOobject::writeOption write)
{
    return IOobject(name, mesh.time().timeName(), mesh, read, write);
}

}

bedFoam::GasFields::GasFields(const fvMesh& mesh)
    : p(named("p", mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      U(named("U", mesh, IOobject::MUST_READ, IOobject::AUTO_WRITE), mesh),
      phi(named("phi", mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), fvc::flux(U)),
      gradP(named("gradP", mesh, IOobject::READ_IF_PRESENT, IOobject::AUTO_WRITE), fvc::grad(p)())
{
    mesh.setFluxRequired(p.name());
}

bedFoam::SolidsFields::SolidsFields(const fvMesh& mesh)
    : voidage(
          named("voidage", mesh, IOobject::NO_READ, IOobject::AUTO_WRITE), mesh,
          dimensionedScalar("one", dimless, 1), zeroGradientFvPatchScalarField::typeName
      ),
      dragRate(
          named("dragRate", mesh, IOobject::NO_READ, IOobject::NO_WRITE), mesh,
          dimensionedScalar("zero", dimless / dimTime, 0), zeroGradientFvPatchScalarField::typeName
      ),
      dragSource(
          named("dragSource", mesh, IOobject::NO_READ, IOobject::NO_WRITE), mesh,
          dimensionedVector("zero", dimAcceleration, Zero), zeroGradientFvPatchVectorField::typeName
      )
{}
