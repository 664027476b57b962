import java.io.PrintStream;
import org.eclipse.emf.ecore.EAttribute;
import org.eclipse.emf.ecore.EClass;
import org.eclipse.emf.ecore.EClassifier;
import org.eclipse.emf.ecore.EDataType;
import org.eclipse.emf.ecore.EEnum;
import org.eclipse.emf.ecore.EEnumLiteral;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.EReference;
import org.eclipse.emf.ecore.EStructuralFeature;
import org.eclipse.emf.ecore.util.EcoreUtil;

/** Tells what EMF has understood of a metamodel, one line for each class, feature, literal and data type. */
final class Metamodels {
  private Metamodels() {}

  static void describe(EPackage metamodel, PrintStream out) {
    String uri = metamodel.getNsURI();
    out.println("PACKAGE " + uri + " " + metamodel.getName() + " " + metamodel.getNsPrefix());
    for (EClassifier classifier : metamodel.getEClassifiers()) {
      if (classifier instanceof EClass kind) {
        boolean isAbstract = kind.isAbstract() || kind.isInterface();
        out.println("CLASS " + uri + "#" + kind.getName() + " abstract=" + isAbstract);
        kind.getESuperTypes().forEach(above -> out.println("SUPER " + name(kind) + " " + name(above)));
        kind.getEAllStructuralFeatures().forEach(feature -> out.println(described(kind, feature)));
      } else if (classifier instanceof EEnum enumeration) {
        for (EEnumLiteral literal : enumeration.getELiterals()) {
          out.println("LITERAL " + name(enumeration) + " " + literal.getName() + " " + literal.getValue() + " "
              + literal.getLiteral());
        }
      } else if (classifier instanceof EDataType type) {
        out.println("DATATYPE " + name(type) + " serializable=" + type.isSerializable());
      }
    }
  }

  private static String described(EClass kind, EStructuralFeature feature) {
    EReference reference = feature instanceof EReference found ? found : null;
    EReference opposite = reference == null ? null : reference.getEOpposite();
    Object value = reference != null || feature.isMany() ? null : feature.getDefaultValue();
    return "FEATURE " + name(kind) + " " + feature.getName() + " type=" + name(feature.getEType())
        + " bounds=" + feature.getLowerBound() + ".." + feature.getUpperBound()
        + " containment=" + (reference != null && reference.isContainment())
        + " unsettable=" + feature.isUnsettable() + " unique=" + feature.isUnique()
        + " id=" + (feature instanceof EAttribute attribute && attribute.isID())
        + " transient=" + feature.isTransient()
        + " opposite=" + (opposite == null ? "" : name(opposite.getEContainingClass()) + "/" + opposite.getName())
        + " default=" + (value == null ? "" : EcoreUtil.convertToString((EDataType) feature.getEType(), value));
  }

  static String name(EClassifier classifier) {
    return classifier.getEPackage().getNsURI() + "#" + classifier.getName();
  }
}
