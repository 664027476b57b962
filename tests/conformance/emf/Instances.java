import java.io.ByteArrayOutputStream;
import java.io.File;
import java.io.PrintStream;
import java.nio.file.Files;
import java.util.ArrayList;
import java.util.HashMap;
import java.util.LinkedHashSet;
import java.util.List;
import java.util.Map;
import java.util.Random;
import java.util.function.Supplier;
import org.eclipse.emf.common.util.URI;
import org.eclipse.emf.ecore.EAttribute;
import org.eclipse.emf.ecore.EClass;
import org.eclipse.emf.ecore.EEnum;
import org.eclipse.emf.ecore.EObject;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.EReference;
import org.eclipse.emf.ecore.EStructuralFeature;
import org.eclipse.emf.ecore.EcorePackage;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.resource.ResourceSet;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.XMIResource;
import org.eclipse.emf.ecore.xmi.XMLResource;
import org.eclipse.emf.ecore.xmi.impl.XMIResourceFactoryImpl;
import org.eclipse.emf.ecore.xmi.impl.XMIResourceImpl;

/** Random models of all kinds of class, feature and file; required values may be missing. */
final class Instances {
  private static final int DEEPEST = 3;
  private static final int MOST = 30;
  private final List<EClass> kinds = new ArrayList<>();
  private final List<EObject> elements = new ArrayList<>();
  private final ResourceSet resources;
  private final Supplier<ResourceSet> again;
  private final Random random;
  private final Values values;

  /** Makes resources that give universally unique identifiers where the file's name asks for it. */
  static final class Factory extends XMIResourceFactoryImpl {
    @Override
    public Resource createResource(URI uri) {
      boolean identified = uri.lastSegment() != null && uri.lastSegment().contains("uuid");
      return new XMIResourceImpl(uri) {
        @Override
        protected boolean useUUIDs() {
          return identified;
        }
      };
    }
  }

  Instances(List<EPackage> packages, Random random, Supplier<ResourceSet> resources) {
    this.random = random;
    this.again = resources;
    this.resources = resources.get();
    this.values = new Values(random);
    packages.forEach(each -> each.getEClassifiers().forEach(classifier -> {
      if (classifier instanceof EClass kind && !kind.isAbstract() && !kind.isInterface()) {
        kinds.add(kind);
      }
    }));
  }

  /** Writes one model, into one file or two, and prints their names. */
  void write(File folder, String flavour, PrintStream out) throws Exception {
    List<EClass> large = kinds.stream().filter(kind -> !kind.getEAllContainments().isEmpty()).toList();
    List<Resource> files = new ArrayList<>();
    int count = 1 + random.nextInt(2);
    for (int file = 0; file < count; file++) {
      String name = flavour + "-" + file + (random.nextInt(8) == 0 ? "-uuid" : "") + ".xmi";
      files.add(resources.createResource(URI.createFileURI(new File(folder, name).getAbsolutePath())));
      int roots = random.nextInt(6) == 0 ? 2 + random.nextInt(2) : 1;
      for (int root = 0; root < roots; root++) {
        files.get(file).getContents().add(tree(values.pick(random.nextInt(9) == 0 ? kinds : large), 0));
      }
    }
    new ArrayList<>(elements).forEach(this::refer);
    if (files.size() > 1 && random.nextBoolean()) {
      containAcross(files.get(0), files.get(1));
    }
    for (Resource file : files) {
      identify((XMLResource) file);
      save((XMLResource) file);
    }
    boolean kept = files.stream().allMatch(this::isKept);
    files.forEach(file -> out.println((kept ? "MADE " : "LOST ") + file.getURI().lastSegment()));
  }

  /** Tells whether EMF finds in a file what it wrote there: there are things that it loses. */
  private boolean isKept(Resource file) {
    try {
      Resource found = again.get().getResource(file.getURI(), true);
      EcoreUtil.resolveAll(found);
      boolean sound = found.getErrors().isEmpty()
          && EcoreUtil.UnresolvedProxyCrossReferencer.find(found).isEmpty();
      return sound && new Equality().equals(file.getContents(), found.getContents());
    } catch (RuntimeException fault) {
      return false;
    }
  }

  private EObject tree(EClass kind, int depth) {
    EObject element = EcoreUtil.create(kind);
    elements.add(element);
    for (EStructuralFeature feature : kind.getEAllStructuralFeatures()) {
      if (feature.isTransient() || feature.getName().equals("href")) { // EMF takes that for a link and loses it
        continue;
      }
      if (feature instanceof EAttribute attribute) {
        give(element, attribute);
      } else if (((EReference) feature).isContainment() && depth < DEEPEST) {
        grow(element, (EReference) feature, depth);
      }
    }
    return element;
  }

  private void give(EObject element, EAttribute attribute) {
    boolean key = attribute.getName().equals("key");
    if (!key && random.nextInt(5) < 2) {
      return;
    }
    if (attribute.isMany()) {
      LinkedHashSet<Object> chosen = new LinkedHashSet<>();
      for (int count = random.nextInt(4); count > 0; count--) {
        chosen.add(values.of(attribute.getEAttributeType(), false));
      }
      chosen.remove(null);
      List<Object> all = new ArrayList<>(chosen);
      if (nullable(attribute) && random.nextInt(4) == 0) {
        all.add(null);
      }
      element.eSet(attribute, all);
      return;
    }
    Object value = values.of(attribute.getEAttributeType(), key || attribute.isID());
    if (nullable(attribute) && attribute.isUnsettable() && random.nextInt(6) == 0) {
      element.eSet(attribute, null);
    } else if (value != null) {
      element.eSet(attribute, value);
    }
  }

  private static boolean nullable(EAttribute attribute) {
    Class<?> kind = attribute.getEAttributeType().getInstanceClass();
    return kind != null && !kind.isPrimitive() && !(attribute.getEAttributeType() instanceof EEnum);
  }

  private void grow(EObject element, EReference feature, int depth) {
    List<EClass> fitting = kinds.stream().filter(kind -> fits(feature, kind)).toList();
    int most = fitting.isEmpty() || elements.size() > MOST ? 0 : random.nextInt(feature.isMany() ? 4 : 2);
    for (int count = 0; count < most; count++) {
      add(element, feature, tree(values.pick(fitting), depth + 1));
    }
    if (most == 0 && feature.isUnsettable() && !feature.isMany() && random.nextBoolean()) {
      element.eSet(feature, null);
    }
  }

  private static boolean fits(EReference feature, EClass kind) {
    EClass wanted = feature.getEReferenceType();
    boolean any = wanted == EcorePackage.Literals.EOBJECT || wanted.isSuperTypeOf(kind);
    return wanted == kind || any && kind.getInstanceClassName() == null;
  }

  private void refer(EObject element) {
    for (EReference feature : element.eClass().getEAllReferences()) {
      if (feature.isContainment() || feature.isContainer() || feature.isTransient() || random.nextInt(5) < 2) {
        continue;
      }
      List<EObject> fitting = elements.stream().filter(feature.getEReferenceType()::isInstance).toList();
      for (int count = feature.isMany() ? random.nextInt(4) : 1; count > 0 && !fitting.isEmpty(); count--) {
        EObject target = values.pick(fitting);
        if (feature.getEOpposite() == null || target != element) { // EMF loses who is its own mate
          add(element, feature, target);
        }
      }
    }
  }

  @SuppressWarnings("unchecked")
  private static void add(EObject element, EReference feature, EObject value) {
    if (feature.isMany()) {
      List<EObject> present = (List<EObject>) element.eGet(feature);
      if (!present.contains(value)) { // EMF mixes up the order of repeated ones
        present.add(value);
      }
    } else {
      element.eSet(feature, value);
    }
  }

  /** Contains a root of the second file in an element of the first one, where it stays in its file. */
  private void containAcross(Resource first, Resource second) {
    EObject root = second.getContents().get(0);
    if (root.eClass().getInstanceClassName() != null) {
      return;
    }
    for (EObject element : elements) {
      for (EReference feature : element.eClass().getEAllContainments()) {
        boolean empty = feature.isMany() || element.eGet(feature) == null;
        if (element.eResource() == first && fits(feature, root.eClass()) && empty && !feature.isTransient()) {
          add(element, feature, root);
          return;
        }
      }
    }
  }

  private void identify(XMLResource file) {
    int every = random.nextInt(4);
    int number = 0;
    for (EObject element : elements) {
      if (every == 1 && element.eResource() == file && file.getID(element) == null && random.nextBoolean()) {
        file.setID(element, "_x" + ++number);
      }
    }
  }

  private void save(XMLResource file) throws Exception {
    Map<Object, Object> options = new HashMap<>();
    boolean plain = elements.stream().allMatch(each -> each.eClass().getName().chars().allMatch(code -> code < 128));
    List<String> encodings = List.of("UTF-8", "UTF-16", "ISO-8859-1", plain ? "ASCII" : "UTF-8"); // EMF spoils names
    options.put(XMLResource.OPTION_ENCODING, values.pick(encodings));
    options.put(XMIResource.OPTION_USE_XMI_TYPE, random.nextInt(4) == 0);
    options.put(XMLResource.OPTION_SCHEMA_LOCATION, random.nextInt(4) == 0);
    options.put(XMLResource.OPTION_KEEP_DEFAULT_CONTENT, random.nextInt(4) == 0);
    options.put(XMLResource.OPTION_SAVE_TYPE_INFORMATION, random.nextInt(4) == 0);
    options.put(XMLResource.OPTION_FORMATTED, random.nextInt(4) > 0);
    if (random.nextInt(4) == 0) {
      options.put(XMLResource.OPTION_LINE_WIDTH, 40);
    }
    ByteArrayOutputStream bytes = new ByteArrayOutputStream();
    file.save(bytes, options);
    Files.write(new File(file.getURI().toFileString()).toPath(), bytes.toByteArray());
  }
}
