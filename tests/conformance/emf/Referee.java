import java.io.File;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import org.eclipse.emf.common.util.Diagnostic;
import org.eclipse.emf.common.util.URI;
import org.eclipse.emf.ecore.EAttribute;
import org.eclipse.emf.ecore.EClass;
import org.eclipse.emf.ecore.EClassifier;
import org.eclipse.emf.ecore.EEnum;
import org.eclipse.emf.ecore.EEnumLiteral;
import org.eclipse.emf.ecore.EObject;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.EReference;
import org.eclipse.emf.ecore.EStructuralFeature;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.resource.ResourceSet;
import org.eclipse.emf.ecore.resource.impl.ResourceSetImpl;
import org.eclipse.emf.ecore.util.Diagnostician;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.XMLResource;
import org.eclipse.emf.ecore.xmi.impl.EcoreResourceFactoryImpl;
import org.eclipse.emf.ecore.xmi.impl.XMIResourceFactoryImpl;

/**
 * Asks Eclipse EMF what it thinks of metamodels and models, and prints one line for each answer.
 *
 * <p>Usage: {@code Referee [--unregistered] ECORE... [-- COMMAND MODEL [OUT]]...} where COMMAND is {@code check} or
 * {@code save}. Unregistered, models find their metamodels by schemaLocation only. Without models, every metamodel is
 * described, feature by feature. The exit code is 0 when EMF has no complaint, else 1.
 */
public final class Referee {
  private final ResourceSet resources = new ResourceSetImpl();
  private boolean complained;

  public static void main(String[] arguments) throws Exception {
    Referee referee = new Referee();
    int index = 0;
    boolean registered = !(arguments.length > 0 && arguments[0].equals("--unregistered"));
    if (!registered) {
      index++;
    }
    List<EPackage> packages = new ArrayList<>();
    List<Resource> metamodels = new ArrayList<>();
    for (; index < arguments.length && !arguments[index].equals("--"); index++) {
      metamodels.add(referee.open(arguments[index]));
    }
    for (Resource metamodel : metamodels) {
      for (EObject root : metamodel.getContents()) {
        referee.gather((EPackage) root, registered, packages);
      }
    }
    for (Resource metamodel : metamodels) {
      referee.judge(metamodel);
    }
    if (index >= arguments.length) {
      packages.forEach(Referee::describe);
    }
    while (index < arguments.length) {
      boolean save = arguments[index + 1].equals("save");
      Resource model = referee.open(arguments[index + 2]);
      referee.judge(model);
      if (save) {
        referee.save(model, arguments[index + 3]);
      }
      index += save ? 4 : 3;
    }
    System.exit(referee.complained ? 1 : 0);
  }

  private Referee() {
    Map<String, Object> factories = resources.getResourceFactoryRegistry().getExtensionToFactoryMap();
    factories.put("ecore", new EcoreResourceFactoryImpl());
    factories.put("*", new XMIResourceFactoryImpl());
  }

  private Resource open(String file) {
    URI uri = URI.createFileURI(new File(file).getAbsolutePath());
    try {
      return resources.getResource(uri, true);
    } catch (RuntimeException fault) {
      Resource broken = resources.getResource(uri, false);
      if (broken == null || broken.getErrors().isEmpty()) {
        complain(file, fault.getMessage());
      }
      return broken;
    }
  }

  private void gather(EPackage found, boolean registered, List<EPackage> packages) {
    packages.add(found);
    if (registered) {
      resources.getPackageRegistry().put(found.getNsURI(), found);
    }
    found.getESubpackages().forEach(inner -> gather(inner, registered, packages));
  }

  private void judge(Resource resource) {
    if (resource == null) {
      return;
    }
    String file = new File(resource.getURI().toFileString()).getName();
    EcoreUtil.resolveAll(resource);
    resource.getErrors().forEach(fault -> complain(file, fault.getLine() + ": " + fault.getMessage()));
    EcoreUtil.UnresolvedProxyCrossReferencer.find(resource).keySet().forEach(
        proxy -> complain(file, "unresolved " + EcoreUtil.getURI(proxy)));
    for (EObject root : resource.getContents()) {
      report(file, Diagnostician.INSTANCE.validate(root));
    }
    System.out.println("JUDGED " + file);
  }

  private void report(String file, Diagnostic diagnostic) {
    if (diagnostic.getSeverity() != Diagnostic.OK && diagnostic.getChildren().isEmpty()) {
      complain(file, diagnostic.getMessage());
    }
    diagnostic.getChildren().forEach(child -> report(file, child));
  }

  private void complain(String file, String message) {
    complained = true;
    System.out.println("FAULT " + file + ": " + message);
  }

  private void save(Resource model, String out) throws Exception {
    Map<Object, Object> options = new HashMap<>();
    options.put(XMLResource.OPTION_ENCODING, "UTF-8");
    model.setURI(URI.createFileURI(new File(out).getAbsolutePath()));
    try (java.io.OutputStream stream = Files.newOutputStream(Path.of(out))) {
      model.save(stream, options);
    }
  }

  private static void describe(EPackage metamodel) {
    String uri = metamodel.getNsURI();
    System.out.println("PACKAGE " + uri + " " + metamodel.getName() + " " + metamodel.getNsPrefix());
    for (EClassifier classifier : metamodel.getEClassifiers()) {
      if (classifier instanceof EClass kind) {
        boolean isAbstract = kind.isAbstract() || kind.isInterface();
        System.out.println("CLASS " + uri + "#" + kind.getName() + " abstract=" + isAbstract);
        kind.getESuperTypes().forEach(above -> System.out.println("SUPER " + name(kind) + " " + name(above)));
        kind.getEAllStructuralFeatures().forEach(feature -> describe(kind, feature));
      } else if (classifier instanceof EEnum enumeration) {
        for (EEnumLiteral literal : enumeration.getELiterals()) {
          System.out.println("LITERAL " + name(enumeration) + " " + literal.getName() + " " + literal.getValue()
              + " " + literal.getLiteral());
        }
      }
    }
  }

  private static void describe(EClass kind, EStructuralFeature feature) {
    EReference reference = feature instanceof EReference found ? found : null;
    EReference opposite = reference == null ? null : reference.getEOpposite();
    Object value = reference != null || feature.isMany() ? null : feature.getDefaultValue();
    System.out.println("FEATURE " + name(kind) + " " + feature.getName() + " type=" + name(feature.getEType())
        + " bounds=" + feature.getLowerBound() + ".." + feature.getUpperBound()
        + " containment=" + (reference != null && reference.isContainment())
        + " unsettable=" + feature.isUnsettable() + " unique=" + feature.isUnique()
        + " id=" + (feature instanceof EAttribute attribute && attribute.isID())
        + " transient=" + feature.isTransient()
        + " opposite=" + (opposite == null ? "" : name(opposite.getEContainingClass()) + "/" + opposite.getName())
        + " default=" + (value == null ? "" : EcoreUtil.convertToString((org.eclipse.emf.ecore.EDataType) feature.getEType(), value)));
  }

  private static String name(EClassifier classifier) {
    return classifier.getEPackage().getNsURI() + "#" + classifier.getName();
  }
}
